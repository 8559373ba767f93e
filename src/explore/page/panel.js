// The panel of a motion: what it is, its charts, its numbers, and what can be done with it.

import { button, element, marked, sentence } from "./element.js";
import { saveButtons } from "./keep.js";
import { mainOutput, model } from "./model.js";
import { Charts } from "./motion.js";
import { keyNumbers, tables } from "./numbers.js";
import { strip } from "./strip.js";
import { asked } from "./view.js";

/** The tables below the charts are there after so long at the latest [ms]. */
const LATEST = 60;

/** A motion in a few words. */
export function summary({ simulate: { orbit } }) {
  return `${orbit.outcome === "periodic" ? `periodic, period ${orbit.period}` : orbit.outcome}, ${mainOutput(orbit[model.main_output.name])}`;
}

function about(it, { from }) {
  const start = `It starts ${from ? "where the line settled at this value" : it.start}; ${it.exact ? `this is case ${it.nearest} of the file` : `it is no case of the file, the nearest is case ${it.nearest}`}.`;
  const why = it.simulate.orbit.failure || it.simulate.failure || "the motion could not be followed";
  const shown = it.history ? `${it.history.cycles} cycles are shown.` : `No history: ${why}.`;
  const note = element("p", { className: "note", textContent: `${start} ${shown}` });
  return [note, ...it.remarks.map((words) => element("p", { className: "remark", textContent: sentence(words) }))];
}

/** A panel with its name and the letter of its ids; `actions` are its first buttons. Motions follow each other in it. */
export class Panel {
  constructor(name, id) {
    Object.assign(this, { name, motion: null });
    this.letter = element("span", { className: "letter", textContent: name });
    this.heading = element("h3");
    this.strip = element("div");
    this.about = element("div");
    this.actions = element("span", { className: "saving" });
    const coordinates = () => asked(this.motion.coordinates);
    this.saving = element("span", { className: "buttons quiet" },
      saveButtons(`${id}-history`, "histories", () => ({ kind: "history", ...coordinates() })),
      saveButtons(`${id}-portrait`, "portrait", () => ({ kind: "phase-portrait", ...coordinates() })));
    const place = element("div", { className: "charts" });
    this.charts = new Charts(place);
    this.note = element("p", { className: "note", textContent: `Histories begin at the section, after the transient. Phase portrait: ${model.surface ? "the dashed line is the surface of impacts, " : ""}rings are stroboscopic points.` });
    this.numbers = element("div");
    this.tables = element("div");
    const head = element("div", { className: "motion-head" }, this.letter, this.heading, this.actions);
    this.element = element("article", { className: "motion" }, head, this.strip, place, this.about, this.note, this.saving, this.numbers, this.tables);
  }

  /** Shows a motion, called by `words`; the panel must be on the page. */
  show(motion, words, scales) {
    const isOther = motion !== this.motion;
    this.motion = motion;
    this.heading.replaceChildren(...marked(words));
    if (isOther) this.tell(motion);
    const { it } = motion, hasHistory = !!it?.history;
    this.note.hidden = !hasHistory;
    // Figures show the histories that files can keep.
    this.saving.hidden = !hasHistory || !model.keeps_histories;
    if (hasHistory) this.charts.show(it, scales); else this.charts.clear();
  }

  /** Shows the histories of a motion of which nothing else is known yet. */
  early(motion, words) {
    this.heading.replaceChildren(...marked(words));
    this.strip.replaceChildren(strip(null));
    for (const it of [this.about, this.numbers, this.tables]) it.replaceChildren();
    [this.note.hidden, this.saving.hidden] = [false, true];
    this.charts.show({ ...motion.it, stroboscopic: [], portrait: [], isEarly: true }, null);
  }

  tell({ it, failure, coordinates }) {
    const open = [...this.tables.children].map((details) => details.open);
    const failed = () => [element("p", { className: "failure", textContent: `The motion could not be computed: ${failure}` })];
    this.strip.replaceChildren(...(it ? [strip(it)] : []));
    this.about.replaceChildren(...(it ? about(it, coordinates) : failed()));
    // The tables below the charts follow when those are seen.
    this.rest = () => {
      this.numbers.replaceChildren(...(it ? [keyNumbers([{ it, name: this.name }])] : []));
      this.tables.replaceChildren(...(it ? tables(it, open) : []));
    };
    setTimeout(() => this.finish(), LATEST);
  }

  /** Tells the rest. */
  finish() {
    this.rest?.();
    this.rest = null;
  }

  /** Sets what can be done: buttons as texts with what they do and their ids, or a note. */
  offer(text, act, id) {
    const key = `${text} ${id}`;
    if (this.offered !== key) this.actions.replaceChildren(act ? button(text, () => this.act(), { id }) : element("span", { className: "note", textContent: text }));
    Object.assign(this, { offered: key, act });
  }
}
