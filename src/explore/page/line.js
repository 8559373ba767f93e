// The bifurcation diagram along a line over the map, drawn as it is computed.

import * as ask from "./ask.js";
import * as busy from "./busy.js";
import * as tip from "./tip.js";
import { Branches } from "./branches.js";
import { button, element, folded, labelled, parted, say, said, select } from "./element.js";
import { copyButton, handOver, saveButtons } from "./keep.js";
import { entry } from "./marks.js";
import { mainOutput, model, shown } from "./model.js";
import { colours, context, frame, redrawn, share } from "./plot.js";
import { range, short } from "./ticks.js";

/** Values along a line. */
const COUNT = 300;
/** How often the value that is computed is marked on the map [ms]. */
const MARKED_EVERY = 250;
const STARTS = [["inherit", "where the value before it settled"], ["afresh", "from the initial state of the study"]];

const square = (drawn, x, y, r) => drawn.fillRect(x - r, y - r, 2 * r, 2 * r);
const plus = (drawn, x, y, r) => { drawn.beginPath(); drawn.moveTo(x - 2 * r, y); drawn.lineTo(x + 2 * r, y); drawn.moveTo(x, y - 2 * r); drawn.lineTo(x, y + 2 * r); drawn.stroke(); };
const hollow = (drawn, x, y, r) => drawn.strokeRect(x - 1.5 * r, y - 1.5 * r, 3 * r, 3 * r);
const triangle = (drawn, x, y, r) => { drawn.beginPath(); drawn.moveTo(x, y - 1.6 * r); drawn.lineTo(x + 1.5 * r, y + 1.2 * r); drawn.lineTo(x - 1.5 * r, y + 1.2 * r); drawn.fill(); };
/** The points of each outcome: they differ in shape and, for all kinds of sight, in blue, orange or grey. */
const KINDS = {
  "periodic": { shade: "first", put: square },
  "chaotic": { shade: "second", put: triangle },
  "quasi-periodic": { shade: "ink", put: plus },
};
const kind = (outcome) => KINDS[outcome] || { shade: "faint", put: hollow };

/** The diagram in its place. `on` is told of `start`, of a `choose`n share of the line and of a `spot` under the pointer. */
export class Line {
  constructor(place, on) {
    Object.assign(this, { on, points: [], marked: 0, running: null, asked: null, spot: null, study: null });
    this.canvas = element("canvas", { id: "line", tabIndex: 0, role: "application", ariaLabel: "Bifurcation diagram along the line" });
    this.canvas.setAttribute("aria-roledescription", "diagram");
    this.canvas.setAttribute("aria-describedby", "line-help line-at");
    this.told = element("p", { id: "line-told" });
    this.at = element("p", { id: "line-at", className: "told", textContent: "\u00a0" });
    this.start = select("line-start", STARTS, "inherit", (start) => on.start(start));
    this.start.id = "line-start";
    this.legend = element("ul", { className: "legend", ariaLabel: "Points of the diagram" });
    this.saving = element("div", { className: "buttons", hidden: true }, saveButtons("line", "diagram", () => this.figure()));
    this.why = element("p", { className: "note" });
    this.branches = new Branches(() => this.draw());
    const help = element("p", { id: "line-help", className: "note", textContent: "Click a value for its motion; arrows step along the line, Enter computes there." });
    this.values = element("div");
    const turn = button("Turn round", () => on.turn(), { id: "turn-button", title: "The line from its end to its beginning: the other sweep" });
    const tools = element("div", { className: "buttons" }, labelled("Each value starts", this.start), turn, this.branches.button);
    place.append(tools, this.told, this.canvas, this.at, this.legend, help, this.branches.told, this.values, this.why, this.saving);
    this.listen();
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("pointermove", (event) => this.hover(this.near(event), false, event));
    canvas.addEventListener("pointerleave", () => this.hover(null, false));
    canvas.addEventListener("click", (event) => this.choose(this.near(event)));
    canvas.addEventListener("keydown", (event) => this.key(event));
    redrawn(canvas, () => this.draw());
  }

  /** Computes from one end to the other; `line` has both, the axes of the map, and what is held. Nothing where it is the same as before. */
  async follow(line) {
    const asked = JSON.stringify([line.from, line.to, line.held, line.start, line.along.log]);
    if (asked === this.asked) return;
    this.running?.abort();
    const running = new AbortController();
    this.task?.end(false);
    this.task = busy.begin("line", "Line");
    Object.assign(this, { running, asked, line, points: [], study: null, spot: null });
    this.start.value = line.start;
    this.values.replaceChildren();
    this.branches.clear();
    this.saving.hidden = true;
    this.why.textContent = "";
    handOver("line", "", null);
    this.began = performance.now();
    try {
      await ask.lines("/api/line", this.pairs(), (it) => this.take(it), running.signal);
      this.task.end();
      this.finish();
    } catch (it) {
      if (it.name === "AbortError") return;
      this.task.end(false);
      this.asked = null;
      this.told.textContent = `${this.points.length ? `Stopped after ${this.points.length} values: ` : ""}${it.message}`;
      say(this.told.textContent);
    }
  }

  // What is asked of the server.
  pairs() {
    const { from, to, held, start } = this.line;
    const ends = Object.fromEntries(Object.entries(to).map(([name, value]) => [`to_${name}`, value]));
    return { ...held, ...from, ...ends, ...this.spacing(), count: COUNT, start };
  }

  /** Computes nothing more. */
  stop() {
    this.running?.abort();
    this.task?.end(false);
    this.branches.clear();
    if (this.asked) this.on.spot(null);
    this.asked = null;
    handOver("line", "", null);
  }

  take(it) {
    if (it.share === undefined) return this.describe(it);
    this.points.push(it);
    const done = this.points.length, left = (performance.now() - this.began) / done * (COUNT - done) / 1e3;
    this.told.textContent = `${done} of ${COUNT} values, ${left.toFixed(0)} s left`;
    this.task.tell(`${done} of ${COUNT}`, done / COUNT);
    if (done === 1) say(`The line is computed: ${COUNT} values`);
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.draw();
      // What is computed now is marked on the map, whose drawing takes time from the computation.
      if (this.spot !== null || !this.line || performance.now() - this.marked < MARKED_EVERY && this.points.length < COUNT) return;
      this.marked = performance.now();
      this.on.spot(this.points.length < COUNT && this.points.length ? this.place(this.points.at(-1).share) : null);
    });
  }

  // What the server says of the line as a whole.
  describe({ study, why }) {
    this.study = study;
    this.why.textContent = study || !why ? "" : `The line has no study to hand over: ${why}.`;
    this.saving.hidden = !study;
    handOver("line", "Bifurcation diagram along the line: study for capsulemap sweep", study, true);
  }

  finish() {
    const failed = this.points.filter((it) => it.outcome === "failed").length;
    const without = this.points.filter((it) => it.outcome !== "failed" && !this.section(it).length).length;
    const seconds = ((performance.now() - this.began) / 1e3).toFixed(1);
    const more = [failed && `${failed} failed and have no points`, without && `${without} others have no points`].filter((it) => it);
    this.told.textContent = [`${this.points.length} values in ${seconds} s`, ...more].join("; ").concat(".");
    this.canvas.setAttribute("aria-label", `Bifurcation diagram along the line: ${this.summary()}`);
    say(this.told.textContent);
    this.values.replaceChildren(this.table(), copyButton("Copy as CSV", "Values along the line", () => this.csv()));
    const [axis, ...others] = this.varied();
    // A branch is followed in one parameter.
    if (axis && !others.length && !axis.name.startsWith("start_")) {
      const value = (at) => short(at[axis.name] * axis.factor, 10);
      this.branches.offer({ points: this.points, pairs: this.pairs(), label: axis.label, value, place: (share) => this.place(share) });
    }
    this.draw();
  }

  summary() {
    const count = (of) => this.points.filter(of).length;
    const outputs = this.outputs().filter(Number.isFinite), [low, high] = range(outputs, 0), { label, unit } = model.main_output;
    const periodic = count((it) => it.outcome === "periodic");
    return `${this.points.length} values, ${periodic} periodic; ${parted(label)[0]} from ${short(low, 4)} to ${short(high, 4)} ${unit}`.trim();
  }

  figure() { return { kind: "bifurcation", ...this.pairs() }; }

  // The axes along which the line is straight in their logarithms.
  spacing() {
    const names = this.line.axes.filter((it) => it.log).map((it) => it.name);
    return names.length ? { log: names.join(",") } : {};
  }

  // The first coordinate of the section points of a value, in SI.
  section(it) { return it[model.section[0].name]; }

  // The main output at each value, in the unit shown.
  outputs() {
    const { name, factor } = model.main_output;
    return this.points.map((it) => (it[name] === null ? NaN : it[name] * factor));
  }

  rows() {
    const { main_output: main, section: [first] } = model, coordinates = (all) => all.map((value) => short(value * first.factor, 5)).join("; ");
    const section = (it) => (this.section(it).length > 8 ? `${this.section(it).length} points` : coordinates(this.section(it)) || "none");
    return this.points.map((it) => [...this.varied().map((axis) => short(this.place(it.share)[axis.name] * axis.factor)), it.outcome, it.period ?? "–", section(it), shown(it[main.name], main)]);
  }

  // The axes whose values differ along the line.
  varied() {
    const { axes, from, to } = this.line;
    return axes.filter(({ name }) => from[name] !== to[name]);
  }

  table() {
    const head = [...this.varied().map((it) => it.label), "outcome", "period", model.section[0].label, model.main_output.label];
    return folded("Values along the line", head, () => this.rows());
  }

  /** The same with all digits that are known, in SI and by the names of the program. */
  csv() {
    const axes = this.varied(), { main_output: main, section: [first] } = model, head = [...axes.map((it) => it.name), "outcome", "period", main.name, first.name];
    const number = (value) => (value === null || value === undefined ? "" : String(value));
    const row = (it) => [...axes.map(({ name }) => this.place(it.share)[name]), it.outcome, number(it.period), number(it[main.name]), this.section(it).join(" ")];
    return [head, ...this.points.map(row)].map((cells) => cells.join(",")).join("\n").concat("\n");
  }

  /** The coordinates at a share of the line. */
  place(share) {
    const { from, to, held } = this.line;
    const isLog = (name) => this.line.axes.find((it) => it.name === name)?.log;
    const between = (a, b, name) => (isLog(name) ? a * (b / a) ** share : a + share * (b - a));
    // The ends are kept as they are; between them rounding would leave digits that mean nothing.
    const value = (a, b, name) => (share === 0 || a === b ? a : share === 1 ? b : Number(between(a, b, name).toPrecision(12)));
    return { ...held, ...Object.fromEntries(Object.entries(from).map(([name, a]) => [name, value(a, to[name], name)])) };
  }

  areas({ width, height }) {
    const middle = (height - 42) * 0.6;
    return [{ left: 70, top: 10, right: width - 18, bottom: middle - 8 }, { left: 70, top: middle + 8, right: width - 18, bottom: height - 42 }];
  }

  axis() {
    const { along, from, to } = this.line;
    const ends = [from, to].map((it) => it[along.name] * along.factor);
    return { range: [...ends].sort((a, b) => a - b), label: along.label, log: along.log, ends };
  }

  // The place of the point of the line that is nearest to the pointer.
  near(event) {
    if (!this.points.length) return null;
    const box = this.canvas.getBoundingClientRect(), [area] = this.areas(box), { ends } = this.axis();
    // A click tells whole pixels and a movement parts of them: both must find the same value.
    let across = (Math.floor(event.clientX) - box.left - area.left) / (area.right - area.left);
    if (across < 0 || across > 1) return null;
    if (ends[0] > ends[1]) across = 1 - across;
    const place = Math.round(across * (COUNT - 1));
    return place < this.points.length ? place : null;
  }

  hover(place, isKey, event = null) {
    this.spot = place;
    if (place !== null && event) this.beside(place, event); else tip.hide();
    this.at.textContent = place === null ? "\u00a0" : this.words(place);
    if (isKey && place !== null) say(this.words(place));
    this.on.spot(place === null ? null : this.place(this.points[place].share));
    this.draw();
  }

  // Values beside the pointer.
  beside(place, event) {
    const it = this.points[place], at = this.place(it.share), { main_output: main } = model;
    const rows = this.line.axes.map((axis) => tip.pair(axis.label, short(at[axis.name] * axis.factor)));
    tip.show(event, { head: `${it.outcome}${it.period ? `, period ${it.period}` : ""}`, colour: colours()[kind(it.outcome).shade], rows: [...rows, tip.pair(main.label, shown(it[main.name], main))] });
  }

  words(place) {
    const it = this.points[place], at = this.place(it.share);
    const where = this.line.axes.map((axis) => said(axis.label, at[axis.name] * axis.factor)).join(", ");
    return `${where}: ${it.outcome}${it.period ? `, period ${it.period}` : ""}, ${mainOutput(it[model.main_output.name])}`;
  }

  choose(place) {
    const point = place === null ? null : this.points[place];
    if (!point) return;
    const at = this.place(point.share);
    if (!point.end) return this.on.choose(at);
    // Of several motions at these parameters the one that the line has is shown, whatever the sweep of the file.
    const start = Object.fromEntries(point.end.map((value, i) => [model.starts[i].name, value]));
    delete at.sweep;
    this.on.choose({ ...at, ...start, start_phase: point.phase, from: "line" });
  }

  key(event) {
    const last = this.points.length - 1, far = event.shiftKey ? 10 : 1;
    const isTurned = this.line && this.axis().ends[0] > this.axis().ends[1];
    const step = { ArrowLeft: isTurned ? far : -far, ArrowRight: isTurned ? -far : far }[event.key];
    if (last < 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    if (step) this.hover(Math.min(Math.max((this.spot ?? 0) + step, 0), last), true);
    else if (event.key === "Enter") this.choose(this.spot);
    else return;
    event.preventDefault();
  }

  draw() {
    const made = context(this.canvas), { drawn } = made;
    if (!this.line || !made.width) return;
    const x = this.axis(), [above, below] = this.areas(made), shades = colours(), outputs = this.outputs(), [first] = model.section;
    const at = (share) => this.place(share)[this.line.along.name] * this.line.along.factor;
    const ofPoints = this.points.flatMap((it) => this.section(it).map((value) => value * first.factor));
    const [sections, mains] = this.branches.ranges().map((all, i) => all.map((value) => value * [first, model.main_output][i].factor).filter(Number.isFinite));
    const upper = frame(drawn, above, { ...x, label: "" }, { range: range([...ofPoints, ...sections]), label: first.label });
    const lower = frame(drawn, below, { ...x, label: this.label() }, { range: range([...outputs, ...mains]), label: model.main_output.label });
    this.branches.draw(drawn, upper, lower, at);
    this.points.forEach((point, i) => {
      const across = upper.x(at(point.share)), { shade, put } = kind(point.outcome);
      [drawn.fillStyle, drawn.strokeStyle, drawn.lineWidth] = [shades[shade], shades[shade], 1];
      for (const value of this.section(point)) put(drawn, across, upper.y(value * first.factor), 1);
      if (Number.isFinite(outputs[i])) put(drawn, across, lower.y(outputs[i]), 1.3);
    });
    if (this.spot !== null && this.points[this.spot]) this.drawSpot(drawn, upper.x(at(this.points[this.spot].share)), above, below);
    this.explain(shades);
  }

  drawSpot(drawn, across, above, below) {
    drawn.strokeStyle = colours().ink;
    drawn.lineWidth = 1;
    drawn.setLineDash([3, 3]);
    drawn.beginPath(); drawn.moveTo(across, above.top); drawn.lineTo(across, below.bottom); drawn.stroke();
    drawn.setLineDash([]);
  }

  // Along an oblique line another axis varies, too.
  label() {
    const { along, axes, from, to } = this.line;
    const other = axes.find((it) => it.name !== along.name);
    if (!other || from[other.name] === to[other.name]) return along.label;
    const { ends } = this.axis(), [left, right] = ends[0] <= ends[1] ? [from, to] : [to, from];
    return `${along.label}; ${other.label}: ${short(left[other.name] * other.factor, 4)} to ${short(right[other.name] * other.factor, 4)}`;
  }

  explain(shades) {
    const outcomes = [...new Set(this.points.filter((it) => this.section(it).length).map((it) => it.outcome))].sort();
    const text = JSON.stringify([outcomes, shades, this.branches.all.length]);
    if (text === this.legend.dataset.text) return;
    this.legend.dataset.text = text;
    this.legend.replaceChildren(...outcomes.map((outcome) => entry(outcome, (drawn, [x, y]) => {
      const { shade, put } = kind(outcome);
      [drawn.fillStyle, drawn.strokeStyle, drawn.lineWidth] = [shades[shade], shades[shade], 1.5];
      put(drawn, x, y, 3);
    })), ...this.branches.entries());
  }
}

/** The axis along which a line is longer over a map. */
export function longer({ x, y }, from, to) {
  const length = (axis) => Math.abs(share(axis, to[axis.name] * axis.factor) - share(axis, from[axis.name] * axis.factor));
  return length(x) >= length(y) ? x : y;
}
