// The bifurcation diagram that a file has: the points of all its sweeps, branches, special points and ramps, as its figure has them.

import * as ask from "./ask.js";
import * as busy from "./busy.js";
import * as curves from "./curves.js";
import * as tip from "./tip.js";
import * as view from "./view.js";
import { button, by, element, folded, labelled, marked, parted, say, said, select, sentence, table } from "./element.js";
import { handOver, quoted, saveButtons } from "./keep.js";
import { entry } from "./marks.js";
import { multipliers } from "./numbers.js";
import { colours, context, frame, redrawn, share, within } from "./plot.js";
import { range, result, short } from "./ticks.js";

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

const square = (drawn, x, y, r) => drawn.fillRect(x - r, y - r, 2 * r, 2 * r);
const light = ([r, g, b]) => 0.3 * r + 0.59 * g + 0.11 * b;
const isDark = () => light(colours().paper.match(/[\da-f]{2}/gi).map((it) => parseInt(it, 16))) < 128;
// A colour of the figures, which are on white: what is nearly black there has the colour of the text here.
const shade = (rgb) => (isDark() && light(rgb) < 60 ? colours().ink : `rgb(${rgb})`);
// A special point in the colours of the text and the paper, as points have colours of their own; the shapes are those of the figure.
function symbol(drawn, [x, y], words, radius = 4.5) {
  const { ink, paper } = colours(), isHollow = /grazing|unresolved/.test(words), r = 0.7 * radius;
  if (words !== "event sequence") return curves.point(drawn, [x, y], { words }, radius, ...(isHollow ? [paper, ink] : [ink, paper]));
  for (const [line, tone] of [[3.5, paper], [1.4, ink]]) {
    [drawn.lineWidth, drawn.strokeStyle] = [line, tone];
    drawn.beginPath(); drawn.moveTo(x - r, y - r); drawn.lineTo(x + r, y + r); drawn.moveTo(x - r, y + r); drawn.lineTo(x + r, y - r); drawn.stroke();
  }
}

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
    this.tables();
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
    const { x, panels, cases, branches, special, ramps } = this.data, some = (all, word) => (all.length ? [`${all.length} ${word}`] : []);
    return `Bifurcation diagram of ${panels.map((it) => parted(it.label)[0]).join(", ")} over ${parted(x.label)[0]}: ${[...some(cases, "cases"), ...some(branches, "branches"), ...some(special, "special points"), ...some(ramps, "ramps")].join(", ")}`;
  }

  // The branches of the file and their special points, in the pane.
  tables() {
    const { x, branches, special, panels } = this.data, place = by("curves-place"), made = [];
    const many = (all) => (all.length > 4 ? `${all.length} points` : all.map((it) => short(it, 6)).join("; ")) || "–";
    if (branches.length) {
      const rows = branches.map((it) => [it.name, String(it.period), short(it.ends[0]), short(it.ends[1]), String(it.orbits), `${short(100 * it.stable / it.orbits, 3)} %`]);
      made.push(element("h2", { textContent: "Branches of the file" }), table("Branches of the file", ["branch", "period", `from, ${x.label}`, `to, ${x.label}`, "orbits", "stable"], rows));
    }
    if (special.length) {
      const rows = () => special.map((it) => [it.words, short(it.x, 9), String(it.period), ...panels.map((_, i) => many(it.values[i])), multipliers(it.multipliers)]);
      made.push(folded(`Special points of the branches (${special.length})`, ["point", x.label, "period", ...panels.map((it) => it.label), "multipliers"], rows, true));
    }
    place.replaceChildren(...made);
    place.hidden = !made.length;
    by("branches-empty").hidden = made.length > 0;
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
    const size = (seen > 20_000 ? 0.6 : seen > 4000 ? 0.9 : 1.4) * (this.hasLines() ? 1.3 : 1);
    this.places = all.map((one, i) => {
      const area = areas[i], isLast = i === all.length - 1;
      const place = frame(drawn, area, { range: ends, log: x.log, label: isLast ? x.label : "" }, { range: this.ordinates(one, ends), label: one.panel.label, isAbove: true });
      within(drawn, area, () => this.paint(drawn, one, place, area, size));
      within(drawn, { left: area.left - 6, right: area.right + 6, top: area.top - 6, bottom: area.bottom + 6 }, () => this.symbols(drawn, one, place, ends));
      return { ...one, area, place };
    });
    // The picture without the spot, which follows the pointer.
    this.copy ??= document.createElement("canvas");
    [this.copy.width, this.copy.height] = [this.canvas.width, this.canvas.height];
    this.copy.getContext("2d").drawImage(this.canvas, 0, 0);
    this.mark();
    this.explain(ends);
  }

  paint(drawn, { panel, number }, place, area, size) {
    const { cases, sorts, windows, ramps, x } = this.data, shades = colours();
    drawn.fillStyle = "#80808026";
    for (const [from, to] of windows) drawn.fillRect(place.x(from), area.top, place.x(to) - place.x(from), area.bottom - area.top);
    const [low, high] = this.data.panels[number].section ? [1, -1] : [place.y(0), place.y(0)];
    if (low === high && low > area.top && low < area.bottom) { drawn.fillStyle = shades.line; drawn.fillRect(area.left, low - 0.5, area.right - area.left, 1); }
    const looks = sorts.map(([, colour]) => shade(colour));
    cases.forEach((it, i) => {
      if (it.sort === null) return;
      const across = place.x(it.at[0] * x.factor);
      if (across < area.left - 2 || across > area.right + 2) return;
      drawn.fillStyle = this.data.by ? it.colour ? shade(it.colour) : shades.faint : looks[it.sort];
      for (const value of panel.values[i]) square(drawn, across, place.y(value), size);
    });
    for (const it of ramps) {
      drawn.fillStyle = shade(it.colour);
      for (const [at, value] of it.panels[number]) square(drawn, place.x(at), place.y(value), 0.8);
      [drawn.strokeStyle, drawn.lineWidth] = [shade(it.colour), 1];
      drawn.setLineDash([3, 3]);
      for (const at of it.jumps) { drawn.beginPath(); drawn.moveTo(place.x(at), area.top); drawn.lineTo(place.x(at), area.bottom); drawn.stroke(); }
    }
    for (const [lines, dashes, width] of [[panel.unstable, [4, 3], 1], [panel.stable, [], 1.3]]) {
      [drawn.strokeStyle, drawn.lineWidth] = [shades.ink, width];
      drawn.setLineDash(dashes);
      for (const line of lines) {
        drawn.beginPath();
        line.forEach(([at, value], i) => drawn[i ? "lineTo" : "moveTo"](place.x(at), place.y(value)));
        drawn.stroke();
      }
    }
    drawn.setLineDash([]);
  }

  // Special points in the order of the figure: the last are drawn over the first.
  symbols(drawn, one, place, [low, high]) {
    const all = this.marked(one).filter(({ at }) => at[0] >= low && at[0] <= high);
    for (const { words, at } of curves.ordered(all)) symbol(drawn, [place.x(at[0]), place.y(at[1])], words);
  }

  // The special points of a panel, each with where it is: those of the branches and those of the attractors of the sweeps.
  marked({ panel, number }) {
    const ofBranches = this.data.special.flatMap((it) => it.values[number].map((value) => ({ ...it, at: [it.x, value] })));
    return [...panel.events, ...ofBranches];
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
    for (const it of this.marked(found)) if (far(it.at) <= NEAR && !(best && far(best.at) < far(it.at))) best = { ...it, panel: number };
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
    const words = special ? this.toldOfSpecial(special) : spot ? this.told(spot) : ramp ? this.toldOfRamp(ramp) : "";
    this.at.replaceChildren(...marked(words || "\u00a0"));
    if (isKey && words) say(words);
    if (!event || !words) return tip.hide();
    if (special) this.besideSpecial(special, event);
    else if (spot) this.beside(spot, event);
    else tip.show(event, { head: ramp.name, colour: shade(ramp.colour), rows: [tip.pair(this.data.x.label, short(ramp.at[0])), tip.pair(this.data.panels[ramp.number].label, short(ramp.at[1]))] });
  }

  // What a case is: its motion and its sweep.
  motion(it) {
    const period = it.outcome === "periodic" && it.period ? `, period ${it.period}` : "";
    return `${it.outcome ?? "no outcome"}${period}`;
  }

  // The values of a case, one of each panel that has one, in words.
  values(number) {
    const { panels } = this.data;
    return panels.filter((it) => it.values[number].length).map((it) => {
      const all = it.values[number], [, unit] = parted(it.label);
      return [it.label, all.length > 3 ? `${all.length} values` : all.map((value) => result(value, unit)).join("; ")];
    });
  }

  beside({ number, x }, event) {
    const it = this.data.cases[number], rows = [tip.pair(this.data.x.label, short(x))];
    if (it.sweep) rows.push(["sweep", it.sweep]);
    if (!this.data.by && this.data.sorts.length > 1 && it.attractor !== null && it.attractor !== undefined) rows.push(["drawn as", this.data.sorts[it.sort][0]]);
    for (const [label, text] of this.values(number)) rows.push(tip.pair(label, text));
    tip.show(event, { head: this.motion(it), colour: this.colour(it), rows });
  }

  colour(it) { return this.data.by ? it.colour && shade(it.colour) : shade(this.data.sorts[it.sort][1]); }

  told({ number, x }) {
    const it = this.data.cases[number];
    return [said(this.data.x.label, x), ...(it.sweep ? [`sweep ${it.sweep}`] : []), this.motion(it), ...this.values(number).map(([label, text]) => said(label, text))].join("; ");
  }

  besideSpecial(it, event) {
    const rows = [tip.pair(this.data.x.label, short(it.at[0], 9))];
    if (it.period) rows.push(["period", String(it.period)]);
    const { panels } = this.data;
    panels.forEach((panel, i) => { if (it.values?.[i]?.length === 1 || !it.values && i === it.panel) rows.push(tip.pair(panel.label, short(it.values ? it.values[i][0] : it.at[1]))); });
    if (it.multipliers?.length) rows.push(["multipliers", multipliers(it.multipliers)]);
    tip.show(event, { head: it.words, colour: null, rows: [...rows, ["of", it.multipliers ? "a branch" : "an attractor of a sweep"]] });
  }

  toldOfSpecial(it) {
    const of = it.multipliers ? `on a branch of period ${it.period}; multipliers ${multipliers(it.multipliers)}` : "of an attractor of a sweep";
    return `${sentence(it.words).slice(0, -1)} at ${said(this.data.x.label, short(it.at[0], 9))}, ${of}`;
  }

  toldOfRamp({ name, at, number }) { return `${name}: ${said(this.data.x.label, at[0])}; ${said(this.data.panels[number].label, at[1])}`; }

  click(it, event) {
    this.hover(it, event);
    if (it.special) say(this.toldOfSpecial(it.special));
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
    const [low, high] = this.seen(), one = this.places[0], all = this.marked(one).filter(({ at }) => at[0] >= low && at[0] <= high).sort((a, b) => a.at[0] - b.at[0]);
    if (!all.length) return this.hover({}, null, true);
    const at = this.special ? all.findIndex((it) => it.words === this.special.words && it.at.every((x, i) => x === this.special.at[i])) : by > 0 ? -1 : 0;
    this.hover({ special: { ...all[(at + by + all.length) % all.length], panel: one.number } }, null, true);
  }

  explain([low, high]) {
    const { sorts, cases, by: paint, ramps, windows, x } = this.data, made = [], shades = colours();
    const isIn = (at) => at >= low && at <= high, inside = cases.filter((it) => it.sort !== null && isIn(it.at[0] * x.factor));
    const disc = (colour, r = 3) => (drawn, [at, y]) => { drawn.fillStyle = colour; square(drawn, at, y, r); };
    if (paint?.key.kinds) for (const [name, colour] of paint.key.kinds) made.push(entry(name, disc(colour ? shade(colour) : shades.faint)));
    else if (paint) made.push(entry(`${parted(paint.told)[0]} from ${short(paint.key.range[0], 4)} to ${short(paint.key.range[1], 4)} ${parted(paint.told)[1]}`, (drawn, [at, y]) => {
      const all = paint.key.colours, step = 26 / all.length;
      all.forEach((rgb, i) => { drawn.fillStyle = `rgb(${rgb})`; drawn.fillRect(at - 13 + i * step, y - 4, step + 0.6, 8); });
    }));
    else sorts.forEach(([name, colour], sort) => { if (inside.some((it) => it.sort === sort) && (sorts.length > 1 || this.hasLines())) made.push(entry(sorts.length > 1 ? name : "settled", disc(shade(colour)))); });
    if (windows.some(([from, to]) => to > low && from < high)) made.push(entry("coexistence", (drawn, [at, y]) => { drawn.fillStyle = "#80808040"; drawn.fillRect(at - 12, y - 7, 24, 14); }));
    const line = (dashes, width) => (drawn, [at, y]) => {
      drawn.setLineDash(dashes);
      [drawn.strokeStyle, drawn.lineWidth] = [shades.ink, width];
      drawn.beginPath(); drawn.moveTo(at - 13, y); drawn.lineTo(at + 13, y); drawn.stroke();
    };
    if (this.hasLines("stable")) made.push(entry("stable orbits", line([], 1.4)));
    if (this.hasLines("unstable")) made.push(entry("unstable orbits", line([4, 3], 1.2)));
    const kinds = new Set(this.shown().flatMap((one) => this.marked(one)).filter(({ at }) => isIn(at[0])).map(({ words }) => words));
    for (const words of kinds) made.push(entry(words, (drawn, at) => symbol(drawn, at, words)));
    for (const it of ramps) made.push(entry(it.name, disc(shade(it.colour), 2.5)));
    if (ramps.some((it) => it.jumps.length)) made.push(entry("jump", line([3, 3], 1)));
    this.legend.replaceChildren(...made);
  }

  // Whether there are lines of a stability, or of any.
  hasLines(kind) {
    const has = (it) => this.data.panels.some((panel) => panel[it].some((line) => line.length > 1));
    return kind ? has(kind) : has("stable") || has("unstable");
  }

  // The command of the figure.
  hand() {
    const { x, panels, colour_by: by } = this.data, all = view.numbers("range", 2), only = view.text("panel"), [, unit] = parted(x.label);
    const names = (only ? [only] : panels.map((it) => it.name)).join(",");
    const limits = all ? ` --limits ${quoted(`${x.name}=${all.map((it) => `${it}${unit && ` ${unit}`}`).join(",")}`)}` : "";
    handOver("map", "Figure of the diagram", `capsulemap figure ${quoted(this.file.file)} --kind bifurcation --x ${x.name} --of ${names}${by ? ` --colour-by ${by}` : ""}${limits}`);
  }
}
