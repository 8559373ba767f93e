// What the map shows: output, axes, direction of the sweep, and the values of the axes that are not drawn.

import * as view from "./view.js";
import { isBasin } from "./attractors.js";
import { by, element, labelled, parted, select } from "./element.js";
import { short } from "./ticks.js";

/** A value is that of the axis if it differs by less than this, relative to the range. */
const SAME = 1e-9;

/** The choices over a file, with their form. */
export class Choices {
  constructor(file) {
    this.file = file;
    this.drawn = "";
  }

  /** The axis called `name`. */
  axis(name) { return this.file.axes.find((it) => it.name === name); }

  /** The output and the axes of the map; the last two axes unless others are chosen. */
  chosen() {
    const { axes, outputs } = this.file, known = (key, all) => all.find((it) => it.name === view.text(key));
    // Over starts alone it is the attractor that differs, and the first coordinate lies across.
    const isPlane = isBasin(this.file), first = isPlane && outputs.find((it) => it.name === "attractor");
    const usual = first || outputs.find((it) => it.name === this.file.model.main_output.name) || outputs[0];
    const x = known("x", axes) || axes.at(isPlane ? 0 : -1), others = axes.filter((it) => it !== x);
    const y = others.find((it) => it.name === view.text("y")) || others.at(isPlane ? 0 : -1);
    return { of: (known("of", outputs) || usual).name, x: x?.name, y: y?.name };
  }

  /** The axes that are not drawn. */
  others() {
    const { x, y } = this.chosen();
    return this.file.axes.filter((it) => it.name !== x && it.name !== y);
  }

  /** The place along an axis that is nearest to a value. */
  nearest({ values }, wanted) {
    return values.reduce((best, value, i) => (Math.abs(value - wanted) < Math.abs(values[best] - wanted) ? i : best), 0);
  }

  /** The values of the axes that are not drawn, in SI. */
  held() {
    const value = (it) => it.values[this.nearest(it, view.number(it.name) ?? it.values[0])];
    return Object.fromEntries(this.others().map((it) => [it.name, value(it)]));
  }

  sweep() {
    const { directions } = this.file, all = [...directions, "difference"];
    return directions.length > 1 ? { sweep: all.includes(view.text("sweep")) ? view.text("sweep") : directions[0] } : {};
  }

  /** The sweep from whose motions cases start: that of the map, or the first where it shows a difference. */
  from() {
    const { sweep } = this.sweep();
    return sweep === "difference" ? { sweep: this.file.directions[0] } : this.sweep();
  }

  /** What is asked of the server for the map. */
  asked() { return { ...this.chosen(), ...this.held(), ...this.sweep() }; }

  /** The keys of the address on which the map depends. */
  keys() { return ["of", "x", "y", "sweep", ...this.file.axes.map((it) => it.name)]; }

  /** What the address asks for and the file does not have, in sentences. */
  unknown() {
    const told = [];
    for (const it of this.others()) {
      const wanted = view.number(it.name);
      if (wanted === null) continue;
      const value = it.values[this.nearest(it, wanted)], room = SAME * Math.max(...it.values.map(Math.abs));
      if (Math.abs(value - wanted) > room) told.push(`${parted(it.label)[0]} has no value ${short(wanted * it.factor)} ${it.unit}; the map shows the nearest, ${short(value * it.factor)} ${it.unit}.`);
    }
    const { directions } = this.file, sweep = view.text("sweep");
    if (sweep && ![...directions, ...(directions.length > 1 ? ["difference"] : [])].includes(sweep)) told.push(`The file has no sweep ${sweep}.`);
    for (const [key, all] of [["of", this.file.outputs], ["x", this.file.axes], ["y", this.file.axes]]) {
      const name = view.text(key);
      if (name && !all.some((it) => it.name === name)) told.push(`The file has no ${key === "of" ? "output" : "axis"} ${name}.`);
    }
    return told;
  }

  /** Sets other axes; the place `at` that is shown stays, as far as the held axes have its values. */
  turn(key, name) {
    const { x, y } = this.chosen(), old = { x, y }, other = key === "x" ? "y" : "x";
    const axes = { ...old, [key]: name, [other]: old[other] === name ? old[key] : old[other] };
    const at = { ...this.held(), ...view.coordinates(view.text("at")) }, set = { ...axes, window: null };
    for (const it of this.file.axes) {
      if (it.name === axes.x || it.name === axes.y) { set[it.name] = null; continue; }
      set[it.name] = it.values[this.nearest(it, at[it.name] ?? it.values[0])];
      if (at[it.name] !== set[it.name]) delete at.from;
      at[it.name] = set[it.name];
    }
    if (view.coordinates(view.text("at"))) set.at = view.written(at);
    view.step(set);
  }

  /** Builds the form; only where other axes are drawn is it built anew. */
  draw() {
    const { x, y } = this.chosen(), key = `${x} ${y}`;
    if (this.drawn === key) return this.refresh();
    this.drawn = key;
    const focused = document.activeElement?.name;
    const outputs = this.file.outputs.map((it) => [it.name, it.label]), axes = this.file.axes.map((it) => [it.name, it.label]);
    const fields = [labelled("Output", select("of", outputs, this.chosen().of, (of) => view.step({ of, limits: null, scale: null })))];
    for (const [name, text] of [["x", "Across"], ["y", "Up"]]) fields.push(labelled(text, select(name, axes, this.chosen()[name], (it) => this.turn(name, it))));
    const { directions } = this.file;
    if (directions.length > 1) {
      const all = [...directions, "difference"].map((it) => [it, it]);
      fields.push(labelled("Sweep", select("sweep", all, this.sweep().sweep, (sweep) => this.turnSweep(sweep))));
    }
    this.sliders = this.others().map((it) => this.slider(it));
    by("choices").replaceChildren(...fields, ...this.sliders.map((it) => it.place));
    if (focused) by("choices").elements[focused]?.focus();
  }

  // The case that is shown is then that of the other sweep.
  turnSweep(sweep) {
    const at = view.coordinates(view.text("at")), from = sweep === "difference" ? this.file.directions[0] : sweep;
    view.step({ sweep, ...(at && !at.from ? { at: view.written({ ...at, sweep: from }) } : {}) });
  }

  slider(axis) {
    const input = element("input", { type: "range", min: 0, max: axis.values.length - 1, step: 1, name: axis.name });
    const says = element("output");
    input.addEventListener("input", () => this.slid(axis.name, axis.values[input.value]));
    const refresh = () => {
      const value = this.held()[axis.name], text = `${short(value * axis.factor)} ${axis.unit}`;
      input.value = this.nearest(axis, value);
      input.setAttribute("aria-valuetext", text);
      says.textContent = text;
    };
    refresh();
    return { refresh, place: element("label", { className: "slider" }, parted(axis.label)[0], " ", input, says) };
  }

  // The place that is shown moves with the slider.
  slid(name, value) {
    const at = view.coordinates(view.text("at"));
    view.settle({ [name]: value, ...(at ? { at: view.written(view.moved(at, { [name]: value })) } : {}) });
  }

  refresh() {
    const now = { ...this.chosen(), ...this.sweep() };
    for (const name of ["of", "x", "y", "sweep"]) {
      const field = by("choices").elements[name];
      if (field && field.value !== now[name]) field.value = now[name];
    }
    this.sliders.forEach((it) => it.refresh());
  }
}
