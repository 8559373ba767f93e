// The motion of the chosen case and those that are pinned, beside each other.

import * as ask from "./ask.js";
import * as busy from "./busy.js";
import { by, say, said } from "./element.js";
import { handOver } from "./keep.js";
import { common } from "./motion.js";
import { keyNumbers } from "./numbers.js";
import { Panel, summary } from "./panel.js";
import { recoloured } from "./plot.js";
import { short } from "./ticks.js";
import { asked, written } from "./view.js";

const LETTERS = ["A", "B"];

/** The motions of cases, each known by its coordinates. `on` is told of what to `pin` and `unpin`. */
export class Motions {
  constructor(file, on) {
    Object.assign(this, { file, on, known: new Map(), current: null, pins: [], isSame: false, asking: null });
    this.panels = [new Panel("Chosen", "motion"), ...LETTERS.map((name) => new Panel(`Pinned ${name}`, `pin-${name.toLowerCase()}`))];
    this.empty = by("motion-empty");
    recoloured("motions", () => this.draw());
  }

  /** The coordinates of a case in words. */
  words(coordinates) {
    const starts = coordinates.from ? [] : this.file.model.starts;
    const shown = [...this.file.axes, ...(this.file.draws || []), ...this.file.constants, ...starts];
    const isNew = (it, i) => shown.findIndex((other) => other.name === it.name) === i;
    const words = shown.filter((it, i) => isNew(it, i) && it.name in coordinates).map((it) => said(it.label, coordinates[it.name] * it.factor));
    const more = [coordinates.sweep && `sweep ${coordinates.sweep}`, coordinates.from && "from the motion of the line"];
    return [...words, ...more.filter((it) => it)].join(", ");
  }

  async motion(coordinates, signal, early) {
    const key = written(coordinates);
    if (!this.known.has(key)) {
      const it = {};
      // Histories that come before the rest are drawn at once.
      await ask.lines("/api/click", asked(coordinates), (part) => {
        Object.assign(it, part, it.history && { history: it.history });
        if (!it.simulate) early?.({ key, coordinates, it: { ...it } });
      }, signal);
      this.known.set(key, { key, coordinates, it });
    }
    return this.known.get(key);
  }

  /** Shows the motion of a case; false where another was asked for before it came. */
  async show(coordinates) {
    this.asking?.abort();
    const { signal } = this.asking = new AbortController();
    const task = busy.begin("motion", "Motion");
    let motion;
    try {
      motion = await this.motion(coordinates, signal, (it) => this.drawEarly(it));
    } catch (it) {
      motion = { key: written(coordinates), coordinates, failure: it.message };
    }
    task.end(!signal.aborted);
    if (signal.aborted) return false;
    this.current = motion;
    this.forget();
    this.draw();
    say(motion.failure || `Motion at ${this.words(coordinates)}: ${summary(motion.it)}`);
    return true;
  }

  // The histories of the chosen motion, of which nothing else is known yet.
  drawEarly(motion) {
    if (this.pins.length) return;
    const [panel] = this.panels;
    this.place([panel.element]);
    panel.early(motion, this.words(motion.coordinates));
    this.on.drawn();
  }

  /** Shows no chosen motion. */
  clear() {
    this.asking?.abort();
    this.current = null;
    this.forget();
    this.draw();
  }

  // What is not shown any more is computed again where it is asked for.
  forget() {
    const shown = [this.current, ...this.pins].map((it) => it?.key);
    for (const key of this.known.keys()) if (!shown.includes(key)) this.known.delete(key);
  }

  /** Pins the motions of these cases. */
  async pin(all) {
    const failed = (coordinates) => (it) => ({ key: written(coordinates), coordinates, failure: it.message });
    this.pins = await Promise.all(all.map((coordinates) => this.motion(coordinates).catch(failed(coordinates))));
    this.draw();
  }

  /** Draws the motions again, on the same scales or on their own. */
  scale(isSame) {
    this.isSame = isSame;
    this.draw();
  }

  draw() {
    const all = [this.current, ...this.pins], shown = all.map((motion, i) => [motion, this.panels[i]]).filter(([motion]) => motion);
    const fit = shown.map(([motion]) => motion).filter(({ it }) => it);
    const scales = this.isSame && fit.length > 1 ? common(fit.map(({ it }) => it)) : null;
    this.place(shown.length ? shown.map(([, panel]) => panel.element) : [this.empty]);
    shown.forEach(([motion, panel]) => panel.show(motion, this.words(motion.coordinates), scales));
    this.offer();
    by("same-label").hidden = fit.length < 2;
    by("same-note").textContent = scales ? `Histories show the first ${short(scales["Time (s)"][1], 3)} s of each.` : "";
    const named = all.map((motion, i) => ({ it: motion?.it, name: ["Chosen", ...LETTERS][i] })).filter(({ it }) => it);
    by("compared").replaceChildren(...(named.length > 1 ? [keyNumbers(named)] : []));
    handOver("motion", "Chosen motion", this.current?.it?.command);
    LETTERS.forEach((name, i) => handOver(`pin-${name.toLowerCase()}`, `Pinned motion ${name}`, this.pins[i]?.it?.command));
  }

  /** Tells what follows below the charts, when those are seen. */
  finish() { this.panels.forEach((it) => it.finish()); }

  place(panels) {
    by("motion-section").classList.toggle("compare", this.pins.length > 0);
    by("motions").dataset.count = panels.length;
    const now = [...by("motions").children];
    if (now.length !== panels.length || now.some((it, i) => it !== panels[i])) by("motions").replaceChildren(...panels);
  }

  offer() {
    const [chosen, ...pinned] = this.panels;
    this.pins.forEach(({ key }, i) => pinned[i].offer(`Unpin ${LETTERS[i]}`, () => this.on.unpin(key), `unpin-${LETTERS[i].toLowerCase()}`));
    if (!this.current) return;
    if (!this.current.it) chosen.offer("There is no motion to pin.");
    else if (this.pins.some(({ key }) => key === this.current.key)) chosen.offer("This motion is pinned.");
    else if (this.pins.length === LETTERS.length) chosen.offer("Two motions are pinned: unpin one to pin this.");
    else chosen.offer("Pin to compare", () => this.on.pin(this.current.coordinates), "pin-button");
  }
}
