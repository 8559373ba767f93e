// The bifurcation diagram that a file has: the points of all its sweeps, branches, special points and ramps, as its figure has them.

import * as ask from "./ask.js";
import * as busy from "./busy.js";
import * as curves from "./curves.js";
import * as reading from "./reading.js";
import * as tip from "./tip.js";
import * as view from "./view.js";
import { entries, hasLines, marked, paint, symbol } from "./drawing.js";
import { button, by, element, labelled, marked as indexed, parted, say, select, sentence } from "./element.js";
import { handOver, quoted, saveButtons } from "./keep.js";
import { colours, context, frame, redrawn, share, within } from "./plot.js";
import { range, short } from "./ticks.js";
import { options } from "./units.js";

/** A symbol is meant that lies so near, and a point of a ramp or a branch [CSS pixels]. */
const [NEAR, BESIDE] = [9, 14];
/** A pointer that has moved so far draws a range [CSS pixels]. */
const STILL = 4;
/** The least part of the abscissa that is seen. */
const LEAST = 1e-4;
/** How much higher a panel of section points is than another. */
const HIGHER = 1.5;
/** Parts of the address on which the diagram depends: what lies across, what tells the colours, which panel, and the ends of the abscissa. */
export const KEYS = ["over", "by", "panel", "range"];

/** The diagram in its place; `choose` shows the motion of a case by its coordinates. */
export class Diagram {
  constructor(place, file, choose) {
    Object.assign(this, { file, choose, data: null, asked: null, spot: null, special: null, held: null });
    this.canvas = element("canvas", { id: "diagram", tabIndex: 0, role: "application", ariaLabel: "Bifurcation diagram" });
    this.canvas.setAttribute("aria-roledescription", "diagram");
    this.canvas.setAttribute("aria-describedby", "diagram-help diagram-at");
    this.at = element("p", { id: "diagram-at", className: "told", textContent: "\u00a0" });
    this.legend = element("ul", { className: "legend", ariaLabel: "Marks of the diagram" });
    this.note = element("p", { className: "note", hidden: true });
    this.tools = element("div", { className: "buttons" });
    const help = element("p", { id: "diagram-help", className: "note", textContent: "Click a point for its motion, or a special point for what it is. Drag across, or the wheel, shows a part of the axis. Keys: left and right step along the axis, up and down through the motions there, S through the special points; Enter computes; + and − zoom, 0 shows all." });
    const details = element("details", { className: "help" }, element("summary", { textContent: "Pointer and keys" }), help);
    this.whole = button("All", () => view.step({ range: null }), { title: "Show the whole axis (0)", hidden: true });
    this.saving = saveButtons("diagram", "diagram", () => ({ kind: "bifurcation", stored: 1, ...this.request(), ...this.limits() }));
    place.append(this.tools, this.canvas, this.at, this.legend, this.note, details, element("div", { className: "buttons" }, this.saving));
    const events = { pointerdown: "press", pointermove: "move", pointerup: "release", pointercancel: "drop", pointerleave: "leave", keydown: "key" };
    for (const [name, act] of Object.entries(events)) this.canvas.addEventListener(name, (event) => this[act](event));
    this.canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    redrawn(this.canvas, () => this.draw());
    this.build();
  }

  // The choices over the diagram.
  build() {
    const { diagrams, directions, outputs } = this.file, step = (key) => (value) => view.step({ [key]: value || null });
    const sweeps = directions.length > 1 ? [["direction", "sweep"]] : [];
    const kinds = outputs.filter(({ name }) => name !== "attractor").map((it) => [it.name, parted(it.label)[0].toLowerCase()]);
    this.by = select("by", [["", "as in the figure"], ...sweeps, ...kinds], "", step("by"));
    this.panel = select("panel", [["", "all"]], "", step("panel"));
    this.colouring = labelled("Colours", this.by);
    const fields = [this.colouring];
    if (diagrams.length > 1) fields.unshift(labelled("Over", this.over = select("over", diagrams.map((it) => [it.name, parted(it.label)[0]]), diagrams[0].name, step("over"))));
    this.tools.append(...fields, labelled("Panels", this.panel), this.whole);
  }

  // What is asked of the server.
  request() {
    const x = view.text("over"), by = view.text("by");
    return { ...(x ? { x } : {}), ...(by ? { "colour-by": by } : {}) };
  }

  // The ends of the abscissa for a figure that is saved, and the panel that is seen alone.
  limits() {
    const all = view.numbers("range", 2), panel = view.text("panel");
    return { ...(all ? { "limits-x": all.join(",") } : {}), ...(panel ? { of: panel } : {}) };
  }

  /** Shows what the address asks for. */
  async show() {
    const asked = JSON.stringify(this.request());
    if (asked !== this.asked) {
      this.asking?.abort();
      this.asking = new AbortController();
      const task = busy.begin("diagram", "Diagram");
      try {
        const data = await ask.object("/api/diagram", this.request(), this.asking.signal);
        task.end();
        this.take(data);
        this.asked = asked;
      } catch (it) {
        task.end(false);
        throw it;
      }
    }
    this.by.value = view.text("by") ?? "";
    if (this.over) this.over.value = this.data.x.name;
    this.panel.value = view.text("panel") ?? "";
    this.whole.hidden = !view.numbers("range", 2);
    this.draw();
    this.hand();
  }

  take(data) {
    Object.assign(this, { data, spot: null, special: null });
    // The cases at each value, in the order of the axis.
    const columns = new Map();
    data.cases.forEach((it, i) => {
      if (it.sort === null) return;
      if (!columns.has(it.at[0])) columns.set(it.at[0], []);
      columns.get(it.at[0]).push(i);
    });
    this.columns = [...columns].sort(([a], [b]) => a - b).map(([value, cases]) => ({ x: value * data.x.factor, cases }));
    this.panel.replaceChildren(...[["", "all"], ...data.panels.map((it) => [it.name, parted(it.label)[0]])].map(([value, textContent]) => element("option", { value, textContent })));
    this.colouring.hidden = !data.cases.length;
    reading.tables(data, by("curves-place"));
    by("branches-empty").hidden = !by("curves-place").hidden;
    this.note.textContent = [this.also(), ...data.left_out.map((it) => sentence(it))].filter((it) => it).join(" ");
    this.note.hidden = !this.note.textContent;
    this.canvas.setAttribute("aria-label", this.summary());
    this.canvas.style.minHeight = `${Math.max(300, 60 + 112 * data.panels.length)}px`;
  }

  // Which cases show no point, and why.
  also() {
    const { cases } = this.data, count = (of) => cases.filter(of).length, failed = count((it) => it.outcome === "failed");
    const same = count((it) => it.sort === null && it.outcome !== "failed");
    const parts = [failed && `${failed} failed`, same && `${same} have no point of their own: the motion is that of another sweep, or has no value`].filter((it) => it);
    return parts.length ? `Of ${cases.length} cases ${parts.join(", and ")}.` : "";
  }

  summary() {
    const { x, panels, cases, branches, special, ramps } = this.data, some = (all, one, more = `${one}s`) => (all.length ? [`${all.length} ${all.length === 1 ? one : more}`] : []);
    return `Bifurcation diagram of ${panels.map((it) => parted(it.label)[0]).join(", ")} over ${parted(x.label)[0]}: ${[...some(cases, "case"), ...some(branches, "branch", "branches"), ...some(special, "special point"), ...some(ramps, "ramp")].join(", ")}`;
  }

  // The panels that are seen.
  shown() {
    const only = view.text("panel"), all = this.data.panels.map((panel, number) => ({ panel, number }));
    return all.some(({ panel }) => panel.name === only) ? all.filter(({ panel }) => panel.name === only) : all;
  }

  // The ends of the abscissa as they are seen.
  seen() {
    const all = view.numbers("range", 2);
    return all && all[0] < all[1] ? all : this.data.x.range;
  }

  /** Sees a part of the abscissa; the whole where that is wider. */
  look([from, to], put = view.step) {
    const { range: [low, high], log } = this.data.x, axis = { range: [low, high], log };
    const [a, b] = [Math.max(from, low), Math.min(to, high)];
    if (share(axis, b) - share(axis, a) < LEAST) return;
    const isAll = a <= low && b >= high, round = (it) => Number(it.toPrecision(8));
    put({ range: isAll ? null : `${round(a)},${round(b)}` });
  }

  zoom(factor, at = 0.5) {
    const [low, high] = this.seen(), { log } = this.data.x;
    const value = (share) => (log ? low * (high / low) ** share : low + share * (high - low));
    this.look([value(at - at * factor), value(at + (1 - at) * factor)], view.settle);
  }

  areas({ width, height }) {
    const all = this.shown(), weights = all.map(({ panel }) => (panel.section ? HIGHER : 1)), sum = weights.reduce((a, b) => a + b, 0);
    const gap = 26, free = height - 64 - gap * (all.length - 1);
    let top = 22;
    return all.map((_, i) => {
      const bottom = top + free * weights[i] / sum, area = { left: 56, top, right: width - 18, bottom };
      top = bottom + gap;
      return area;
    });
  }

  // All that lies along the ordinate of a panel over what is seen of the abscissa.
  ordinates({ panel, number }, [low, high]) {
    const { cases, ramps, special, x } = this.data, isIn = (at) => at >= low && at <= high, found = [];
    cases.forEach((it, i) => { if (isIn(it.at[0] * x.factor)) found.push(...panel.values[i]); });
    const points = [...panel.unstable, ...panel.stable, ...ramps.map((it) => it.panels[number])].flat();
    for (const [at, value] of [...points, ...panel.events.map((it) => it.at)]) if (isIn(at)) found.push(value);
    for (const it of special) if (isIn(it.x)) found.push(...it.values[number]);
    return range(found);
  }

  draw() {
    const made = context(this.canvas), { drawn } = made;
    if (!this.data || !made.width) return;
    const ends = this.seen(), all = this.shown(), areas = this.areas(made), { x } = this.data;
    const seen = this.data.cases.reduce((sum, it, i) => sum + (it.sort === null ? 0 : all[0].panel.values[i]?.length ?? 0), 0);
    // Points stand out on both sides of the lines through them.
    const size = (seen > 20_000 ? 0.6 : seen > 4000 ? 0.9 : 1.4) * (hasLines(this.data) ? 1.3 : 1);
    this.places = all.map((one, i) => {
      const area = areas[i], isLast = i === all.length - 1;
      const place = frame(drawn, area, { range: ends, log: x.log, label: isLast ? x.label : "" }, { range: this.ordinates(one, ends), label: one.panel.label, isAbove: true });
      within(drawn, area, () => paint(drawn, this.data, one, place, area, size));
      within(drawn, { left: area.left - 6, right: area.right + 6, top: area.top - 6, bottom: area.bottom + 6 }, () => this.symbols(drawn, one, place, ends));
      return { ...one, area, place };
    });
    this.choice(drawn);
    // The picture without the spot, which follows the pointer.
    this.copy ??= document.createElement("canvas");
    [this.copy.width, this.copy.height] = [this.canvas.width, this.canvas.height];
    this.copy.getContext("2d").drawImage(this.canvas, 0, 0);
    this.mark();
    this.legend.replaceChildren(...entries(this.data, all, ends, this.chosenAt()));
  }

  // Where the motion is that is shown; none beyond what is seen, or where it is one at other parameters.
  chosenAt() {
    const at = view.coordinates(view.text("at"))?.[this.data.x.name], x = at === undefined ? NaN : at * this.data.x.factor, [low, high] = this.seen();
    return x >= low && x <= high ? x : null;
  }

  choice(drawn) {
    const x = this.chosenAt();
    if (x === null) return;
    [drawn.strokeStyle, drawn.lineWidth] = [colours().mark, 1.2];
    for (const { area, place } of this.places) { drawn.beginPath(); drawn.moveTo(place.x(x), area.top); drawn.lineTo(place.x(x), area.bottom); drawn.stroke(); }
  }

  // Special points in the order of the figure: the last are drawn over the first.
  symbols(drawn, one, place, [low, high]) {
    const all = marked(this.data, one).filter(({ at }) => at[0] >= low && at[0] <= high);
    for (const { words, at } of curves.ordered(all)) symbol(drawn, [place.x(at[0]), place.y(at[1])], words);
  }

  // What the pointer or the keyboard has reached.
  mark() {
    const drawn = this.canvas.getContext("2d"), shades = colours(), ratio = window.devicePixelRatio || 1;
    drawn.setTransform(1, 0, 0, 1, 0, 0);
    drawn.clearRect(0, 0, this.canvas.width, this.canvas.height);
    drawn.drawImage(this.copy, 0, 0);
    drawn.setTransform(ratio, 0, 0, ratio, 0, 0);
    const { places, held } = this, first = places[0].area, last = places.at(-1).area;
    if (held?.to !== undefined) {
      drawn.fillStyle = "#80808040";
      drawn.fillRect(Math.min(held.from, held.to), first.top, Math.abs(held.to - held.from), last.bottom - first.top);
    }
    [drawn.strokeStyle, drawn.lineWidth] = [shades.ink, 1];
    const ring = (place, at, radius) => { drawn.beginPath(); drawn.arc(place.x(at[0]), place.y(at[1]), radius, 0, 2 * Math.PI); drawn.stroke(); };
    if (this.special) {
      const { special } = this;
      for (const { place, number, area } of places) {
        const values = special.values?.[number] ?? (special.panel === number ? [special.at[1]] : []);
        within(drawn, { ...area, top: area.top - 8, bottom: area.bottom + 8 }, () => values.forEach((value) => ring(place, [special.at[0], value], 8)));
      }
    } else if (this.spot) {
      const { x, number } = this.spot, across = places[0].place.x(x);
      drawn.setLineDash([3, 3]);
      drawn.beginPath(); drawn.moveTo(across, first.top); drawn.lineTo(across, last.bottom); drawn.stroke();
      drawn.setLineDash([]);
      for (const { place, panel, area } of places) within(drawn, area, () => panel.values[number].slice(0, 64).forEach((value) => ring(place, [x, value], 4)));
    }
  }

  // Where the pointer is on the canvas, and the panel under it.
  under(event) {
    const box = this.canvas.getBoundingClientRect(), [left, top] = [event.clientX - box.left, event.clientY - box.top];
    const found = this.places?.find(({ area }) => left >= area.left - 6 && left <= area.right + 6 && top >= area.top - 6 && top <= area.bottom + 6);
    return { left, top, found };
  }

  // The special point, or the case, that the pointer means.
  meant(event) {
    const { left, top, found } = this.under(event);
    if (!found) return {};
    const { place, panel, number } = found, far = ([x, y]) => Math.hypot(place.x(x) - left, place.y(y) - top);
    let best = null;
    for (const it of marked(this.data, found)) if (far(it.at) <= NEAR && !(best && far(best.at) < far(it.at))) best = { ...it, panel: number };
    if (best) return { special: best };
    return { spot: this.nearest(left, top, place, panel), ramp: this.columns.length ? null : this.ramp(far, number) };
  }

  // The case at the nearest value whose point in this panel is nearest.
  nearest(left, top, place, panel) {
    if (!this.columns.length) return null;
    const { columns } = this;
    let [low, high] = [0, columns.length - 1];
    while (high - low > 1) { const middle = (low + high) >> 1; if (place.x(columns[middle].x) < left) low = middle; else high = middle; }
    const column = Math.abs(place.x(columns[low].x) - left) < Math.abs(place.x(columns[high].x) - left) ? low : high;
    const away = (it) => Math.min(...panel.values[it].map((value) => Math.abs(place.y(value) - top)), 1e9);
    const number = columns[column].cases.reduce((best, it) => (away(it) < away(best) ? it : best));
    return { column, number, x: columns[column].x };
  }

  // The point of a ramp that is near.
  ramp(far, number) {
    let [best, away] = [null, BESIDE];
    for (const it of this.data.ramps) for (const at of it.panels[number]) if (far(at) < away) [best, away] = [{ name: it.name, colour: it.colour, at, number }, far(at)];
    return best;
  }

  press(event) {
    const { left, found } = this.under(event);
    if (!found || event.button !== 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.held = { from: left, area: found.area };
  }

  move(event) {
    if (!this.data) return;
    const { held } = this;
    if (!held) return this.hover(this.meant(event), event);
    const { left } = this.under(event);
    if (Math.abs(left - held.from) > STILL || held.to !== undefined) {
      tip.hide();
      held.to = Math.min(Math.max(left, held.area.left), held.area.right);
      this.mark();
    }
  }

  release(event) {
    const { held } = this;
    this.held = null;
    if (!held) return;
    if (held.to === undefined) return this.click(this.meant(event), event);
    const [low, high] = this.seen(), { log } = this.data.x, { left, right } = held.area;
    const value = (at) => { const part = (at - left) / (right - left); return log ? low * (high / low) ** part : low + part * (high - low); };
    const [from, to] = [held.from, held.to].sort((a, b) => a - b);
    if (to - from > STILL) this.look([value(from), value(to)]); else this.mark();
  }

  drop() { this.held = null; if (this.data) this.mark(); }
  leave() { if (!this.held) this.hover({}); }

  wheel(event) {
    const { left, found } = this.data ? this.under(event) : {};
    if (!found || event.deltaY > 0 && !view.numbers("range", 2)) return;
    event.preventDefault();
    this.zoom(event.deltaY > 0 ? 1.25 : 0.8, Math.min(Math.max((left - found.area.left) / (found.area.right - found.area.left), 0), 1));
  }

  hover({ spot = null, special = null, ramp = null }, event = null, isKey = false) {
    Object.assign(this, { spot, special });
    if (!this.places) return;
    this.mark();
    const { data } = this, words = special ? reading.toldOfSpecial(data, special) : spot ? reading.told(data, spot) : ramp ? reading.toldOfRamp(data, ramp) : "";
    this.at.replaceChildren(...indexed(words || "\u00a0"));
    if (isKey && words) say(words);
    if (!event || !words) return tip.hide();
    if (special) reading.besideSpecial(data, special, event);
    else if (spot) reading.beside(data, spot, event);
    else reading.besideRamp(data, ramp, event);
  }

  click(it, event) {
    this.hover(it, event);
    if (it.special) say(reading.toldOfSpecial(this.data, it.special));
    else if (it.spot) this.compute(it.spot);
  }

  compute({ number }) {
    const it = this.data.cases[number], at = Object.fromEntries(this.data.of_cases.map((name, i) => [name, it.at[i]]));
    this.choose({ ...at, ...(it.sweep ? { sweep: it.sweep } : {}) });
  }

  key(event) {
    if (!this.data || event.ctrlKey || event.metaKey || event.altKey) return;
    const far = event.shiftKey ? 10 : 1, along = { ArrowLeft: -far, ArrowRight: far }[event.key], up = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (along && this.columns.length) this.step(along);
    else if (up && this.spot) this.step(0, up);
    else if (event.key === "Enter" && this.spot && !this.special) this.compute(this.spot);
    else if (event.key.toLowerCase() === "s") this.stepSpecial(event.shiftKey ? -1 : 1);
    else if (event.key === "+" || event.key === "=") this.zoom(0.8);
    else if (event.key === "-") this.zoom(1.25);
    else if (event.key === "0") view.step({ range: null });
    else return;
    event.preventDefault();
  }

  step(along, up = 0) {
    const [low, high] = this.seen(), isIn = ({ x }) => x >= low && x <= high, first = this.columns.findIndex(isIn);
    const column = Math.min(Math.max(this.spot ? this.spot.column + along : first, 0), this.columns.length - 1), { cases, x } = this.columns[column];
    const old = cases.indexOf(this.spot?.number), sweep = this.spot && this.data.cases[this.spot.number].sweep;
    const same = cases.findIndex((it) => this.data.cases[it].sweep === sweep);
    const number = cases[up ? (old + up + cases.length) % cases.length : Math.max(same, 0)];
    this.hover({ spot: { column, number, x } }, null, true);
  }

  // Goes through the special points that are seen, in the order of the abscissa.
  stepSpecial(by) {
    const [low, high] = this.seen(), one = this.places[0], all = marked(this.data, one).filter(({ at }) => at[0] >= low && at[0] <= high).sort((a, b) => a.at[0] - b.at[0]);
    if (!all.length) return this.hover({}, null, true);
    const at = this.special ? all.findIndex((it) => it.words === this.special.words && it.at.every((x, i) => x === this.special.at[i])) : by > 0 ? -1 : 0;
    this.hover({ special: { ...all[(at + by + all.length) % all.length], panel: one.number } }, null, true);
  }

  // The command of the figure.
  hand() {
    const { x, panels, colour_by: by } = this.data, all = view.numbers("range", 2), only = view.text("panel"), [, unit] = parted(x.label);
    const known = [...this.file.diagrams, ...this.file.outputs], shown = [x, ...panels].map(({ name }) => known.find((it) => it.name === name));
    const names = (only ? [only] : panels.map((it) => it.name)).join(",");
    const limits = all ? ` --limits ${quoted(`${x.name}=${all.map((it) => `${it}${unit && ` ${unit}`}`).join(",")}`)}` : "";
    handOver("map", "Figure of the diagram", `capsulemap figure ${quoted(this.file.file)} --kind bifurcation --x ${x.name} --of ${names}${by ? ` --colour-by ${by}` : ""}${options(shown)}${limits}`);
  }
}
