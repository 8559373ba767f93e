// The motion of the chosen case and those that are pinned, beside each other.

import * as ask from "./ask.js";
import { button, by, element, say, said } from "./element.js";
import { handOver, saveButtons } from "./keep.js";
import { charts, common } from "./motion.js";
import { keyNumbers, tables } from "./numbers.js";
import { recoloured } from "./plot.js";
import { written } from "./view.js";

const LETTERS = ["A", "B"];
/** Coordinates of the start, as they are shown. */
const STARTS = {
  start_r: { label: "start x1 − x2 (mm)", factor: 1e3 },
  start_y1: { label: "start y1 (mm/s)", factor: 1e3 },
  start_y2: { label: "start y2 (mm/s)", factor: 1e3 },
  start_phase: { label: "start phase (rad)", factor: 1 },
};

/** The motions of cases, each known by its coordinates. `on` is told of what to `pin` and `unpin`. */
export class Motions {
  constructor(file, on) {
    Object.assign(this, { file, on, known: new Map(), panels: new Map(), current: null, pins: [], isSame: false, asking: null });
    recoloured("motions", () => { this.panels.clear(); this.draw(); });
  }

  /** The coordinates of a case in words. */
  words(coordinates) {
    const shown = [...this.file.axes, ...this.file.constants, ...Object.entries(STARTS).map(([name, it]) => ({ name, ...it }))];
    const isNew = (it, i) => shown.findIndex((other) => other.name === it.name) === i;
    return shown.filter((it, i) => isNew(it, i) && it.name in coordinates).map((it) => said(it.label, coordinates[it.name] * it.factor)).join(", ");
  }

  async motion(coordinates, signal) {
    const key = written(coordinates);
    if (!this.known.has(key)) this.known.set(key, { key, coordinates, it: await ask.object("/api/motion", coordinates, signal) });
    return this.known.get(key);
  }

  /** Shows the motion of a case; an answer that comes after another was asked for is not shown. */
  async show(coordinates) {
    this.asking?.abort();
    const asking = this.asking = new AbortController();
    try {
      this.current = await this.motion(coordinates, asking.signal);
    } catch (it) {
      if (it.name === "AbortError" || asking.signal.aborted) return false;
      this.current = { key: written(coordinates), coordinates, failure: it.message };
    }
    if (asking.signal.aborted) return false;
    // What is not shown any more is forgotten.
    const shown = [this.current, ...this.pins].map((it) => it.key);
    for (const key of this.known.keys()) if (!shown.includes(key)) this.known.delete(key);
    this.draw();
    say(this.current.failure || `Motion at ${this.words(coordinates)}: ${this.sentence(this.current.it)}`);
    return true;
  }

  /** Pins the motions of these cases. */
  async pin(all) {
    const fetched = all.map((coordinates) => this.motion(coordinates).catch((it) => ({ key: written(coordinates), coordinates, failure: it.message })));
    this.pins = await Promise.all(fetched);
    this.draw();
  }

  /** Draws the motions again, on the same scales or on their own. */
  scale(isSame) {
    this.isSame = isSame;
    this.draw();
  }

  all() {
    const pins = this.pins.map((motion, i) => ({ ...motion, name: LETTERS[i], isPinned: true }));
    return this.current ? [{ ...this.current, name: "Chosen", isPinned: false }, ...pins] : pins;
  }

  draw() {
    const all = this.all(), fit = all.filter(({ it }) => it);
    if (!all.length) return;
    const scales = this.isSame && fit.length > 1 ? common(fit.map(({ it }) => it)) : null;
    const keys = all.map((motion) => JSON.stringify([motion.key, motion.name, scales, motion.isPinned || this.pins.length]));
    const panels = all.map((motion, i) => this.panels.get(keys[i]) || this.panel(motion));
    this.panels = new Map(keys.map((key, i) => [key, panels[i]]));
    document.querySelector("main").classList.toggle("compare", this.pins.length > 0);
    by("motions").dataset.count = all.length;
    by("motions").replaceChildren(...panels);
    by("same-label").hidden = all.length < 2;
    by("compared").replaceChildren(...(fit.length > 1 ? [keyNumbers(fit)] : []));
    panels.forEach((panel, i) => this.fill(panel, all[i], scales));
    this.handOver(all);
  }

  // Charts have their width once the panel is on the page.
  fill(panel, { it }, scales) {
    const place = panel.querySelector(".charts");
    if (it?.history && !place.childElementCount) charts(place, it, scales);
  }

  sentence({ simulate: { orbit } }) {
    const speed = orbit.progression_speed === null ? "no speed" : `speed ${said("", orbit.progression_speed * 1e3).slice(3)} mm/s`;
    return `${orbit.outcome === "periodic" ? `periodic, period ${orbit.period}` : orbit.outcome}, ${speed}`;
  }

  panel(motion) {
    const { it, name, coordinates, isPinned } = motion;
    const place = element("article", { className: "motion" });
    place.append(element("h3", { textContent: `${isPinned ? `Pinned ${name}` : name}: ${this.words(coordinates)}` }));
    if (!it) place.append(element("p", { className: "failure", textContent: `The motion could not be computed: ${motion.failure}` }));
    else place.append(...this.about(it));
    place.append(this.buttons(motion), element("div", { className: "charts" }));
    if (!it) return place;
    if (it.history) place.append(element("p", { className: "note", textContent: "Histories begin at the section, after the transient. Phase portrait: the dashed line is the stop, rings are stroboscopic points." }));
    place.append(keyNumbers([motion]), ...tables(it));
    return place;
  }

  about(it) {
    const start = `It starts ${it.start}; ${it.exact ? `this is case ${it.nearest} of the file` : `it is no case of the file, the nearest is case ${it.nearest}`}.`;
    const shown = it.history ? `${it.history.cycles} cycles are shown.` : `No history: ${it.simulate.orbit.failure || it.simulate.failure || "the motion could not be followed"}.`;
    const words = this.sentence(it);
    return [`${words[0].toUpperCase()}${words.slice(1)}.`, `${start} ${shown}`, ...it.remarks].map((textContent) => element("p", { textContent }));
  }

  buttons({ key, it, name, isPinned, coordinates }) {
    const made = element("div", { className: "buttons" });
    const full = !isPinned && this.pins.length >= LETTERS.length, known = !isPinned && this.pins.some((pin) => pin.key === key);
    if (isPinned) made.append(button(`Unpin ${name}`, () => this.on.unpin(key)));
    else if (full || known) made.append(element("span", { className: "note", textContent: known ? "This motion is pinned." : "Two motions are pinned: unpin one to pin this." }));
    else made.append(button("Pin to compare", () => this.on.pin(coordinates), { id: "pin-button" }));
    const id = isPinned ? `pin-${name.toLowerCase()}` : "motion";
    if (it?.history) {
      made.append(...saveButtons(`${id}-history`, "histories", () => ({ kind: "history", ...coordinates })));
      made.append(...saveButtons(`${id}-portrait`, "portrait", () => ({ kind: "phase-portrait", ...coordinates })));
    }
    return made;
  }

  handOver(all) {
    const text = (name) => all.find((it) => it.name === name)?.it?.command;
    handOver("motion", "Chosen motion", text("Chosen"));
    LETTERS.forEach((name) => handOver(`pin-${name.toLowerCase()}`, `Pinned motion ${name}`, text(name)));
  }
}
