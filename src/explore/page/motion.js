// The charts of a motion: histories, phase portrait and stroboscopic section.

import uPlot from "./uPlot.esm.js";
import { element, marked, parted } from "./element.js";
import * as tip from "./tip.js";
import { model } from "./model.js";
import { colours, context, frame, redrawn, room, valuesAt, within } from "./plot.js";
import { range, short } from "./ticks.js";

/** Height of a chart with its title, so that three of them stand in the window beside the map [CSS pixels]. */
const height = () => Math.round(Math.min(Math.max((window.innerHeight - 330) / 3, 140), 230));
/** The colours and dashes of the signals of a chart, in their order. */
const SHADES = ["first", "second", "third", "fourth"];
const DASHES = [undefined, [7, 3], [2, 3], [10, 3]];

// The charts that a motion has: their labels, and their signals with their names, words, colours, factors and dashes.
const charts = ({ signals }) => model.charts.map(({ label, signals: all }) => [
  label, all.map(({ name, label: words, factor }, i) => [name, words, SHADES[i], factor, DASHES[i]]).filter(([name]) => signals[name]),
]).filter(([, all]) => all.length);
const scaled = ({ signals }, [name, , , factor]) => signals[name].map((value) => value * factor);

// The curve of the phase portrait, and the points of the section where that is a plane.
const portrait = ({ signals }) => model.portrait.map(({ name, factor }) => signals[name].map((value) => value * factor));
const isPlane = () => model.section.length > 1;
const section = ({ stroboscopic }) => [0, 1].map((i) => (isPlane() ? stroboscopic.map((it) => it[i] * model.section[i].factor) : []));

// Where the surface of impacts lies along the abscissa of the portrait; none where it does not.
function surface({ surface: at }) {
  const [{ name, factor }] = model.portrait;
  return at !== null && name === model.meets_surface ? at * factor : null;
}

/** The ranges of everything that is drawn of a motion, by the name of its axis. */
function ranges(it) {
  const made = { "Time (s)": [0, it.history.t.at(-1)] };
  for (const [label, all] of charts(it.history)) made[label] = range(all.flatMap((column) => scaled(it.history, column)));
  const [x, y] = portrait(it.history), [sx, sy] = section(it), stop = surface(it.history);
  return { ...made, x: range(stop === null ? x : [...x, stop]), y: range(y), sx: range(sx), sy: range(sy) };
}

/** Ranges that hold all motions, over the time of the shortest history; none where no motion has a history. */
export function common(motions) {
  const all = motions.filter(({ history }) => history).map(ranges);
  if (!all.length) return null;
  const ends = (key) => [Math.min(...all.map((it) => it[key][0])), Math.max(...all.map((it) => it[key][1]))];
  const time = [0, Math.min(...all.map((it) => it["Time (s)"][1]))];
  return { ...Object.fromEntries(Object.keys(all[0]).map((key) => [key, ends(key)])), "Time (s)": time };
}

/** The charts of a motion in a place; another motion is shown in the same charts. */
export class Charts {
  constructor(place) {
    Object.assign(this, { place, plots: [], it: null, synced: `charts-${Math.random()}`, histories: element("div", { className: "histories" }) });
    this.canvases = (isPlane() ? [0, 1] : [0]).map(() => element("canvas", { className: "portrait", role: "img" }));
    this.portraits = element("div", { className: "portraits" }, ...this.canvases);
    const all = [drawPortrait, drawSection];
    this.canvases.forEach((canvas, i) => redrawn(canvas, () => this.it && all[i](canvas, this.it, this.scales)));
    this.canvases.forEach((canvas, i) => {
      canvas.addEventListener("pointermove", (event) => this.it && beside(event, canvas, i ? model.section : model.portrait));
      canvas.addEventListener("pointerleave", tip.hide);
    });
    new ResizeObserver(() => this.fit()).observe(this.histories);
  }

  /** Shows a motion with a history; `scales` are ranges to keep to, or none for its own. */
  show(it, scales) {
    Object.assign(this, { it, scales: scales || ranges(it) });
    const shown = charts(it.history), key = JSON.stringify([shown, colours()]);
    if (key !== this.key) this.build(shown);
    this.key = key;
    shown.forEach(([label, all], i) => this.fill(this.plots[i], label, all));
    this.describe();
    drawPortrait(this.canvases[0], it, this.scales);
    if (isPlane()) drawSection(this.canvases[1], it, this.scales);
  }

  build(shown) {
    this.plots.forEach(({ plot }) => plot.destroy());
    this.plots = shown.map(([label, all]) => {
      const holder = element("div", { role: "img", className: "chart" });
      return { holder, plot: null, label, all };
    });
    this.histories.replaceChildren(...this.plots.map(({ holder }) => holder));
    this.place.replaceChildren(this.histories, this.portraits);
    // The width is known where the charts have their place.
    const width = this.width();
    this.plots.forEach((it, i) => {
      it.holder.append(legend(it.label, it.all));
      it.plot = new uPlot(options(it.label, it.all, this, width, i === shown.length - 1), null, it.holder);
      it.plot.over.addEventListener("pointermove", (event) => this.beside(event, it));
      it.plot.over.addEventListener("pointerleave", tip.hide);
    });
  }

  fill({ plot, holder }, label, all) {
    const { history } = this.it, data = [history.t, ...all.map((column) => scaled(history, column))];
    const ends = all.map(([, words], i) => `${words} from ${range(data[i + 1], 0).map((value) => short(value, 4)).join(" to ")}`);
    holder.setAttribute("aria-label", `${label} over ${history.cycles} cycles, ${short(history.t.at(-1), 4)} s: ${ends.join(", ")}`);
    plot.setData(data);
  }

  describe() {
    const { history, stroboscopic } = this.it, [x, y] = portrait(history), stop = surface(history), ends = (values) => range(values, 0).map((value) => short(value, 4)).join(" to ");
    const words = [
      `Phase portrait: ${model.portrait.map(({ label, unit }, i) => `${parted(label)[0]} from ${ends([x, y][i])}${unit && ` ${unit}`}`).join(", ")}${stop === null ? "" : `, the surface of impacts at ${short(stop)}`}`,
      `Stroboscopic section: ${stroboscopic.length} points; the table of section points has them`,
    ];
    this.canvases.forEach((canvas, i) => canvas.setAttribute("aria-label", words[i]));
  }

  width() { return Math.max(this.histories.clientWidth, 200); }

  fit() {
    const width = this.histories.clientWidth;
    for (const { plot } of this.plots) if (width && width !== plot?.width) plot?.setSize({ width, height: plot.height });
  }

  // Values beside the pointer.
  beside(event, { plot, all }) {
    const at = plot.cursor.idx, shades = colours();
    if (at === null || at === undefined) return tip.hide();
    const rows = all.map(([, words], i) => [words, read(null, plot.data[i + 1][at])]);
    tip.show(event, { head: `t = ${short(plot.data[0][at], 5)} s`, rows });
  }

  /** Shows nothing. */
  clear() {
    Object.assign(this, { it: null, key: null });
    this.place.replaceChildren();
  }
}

// The title of a chart, which is that of its ordinate, and its signals with their strokes.
function legend(label, all) {
  const entry = ([, words, shade, , dash]) => {
    const stroke = element("span", { className: `stroke ${dash ? (dash[0] > 4 ? "dashed" : "dotted") : "solid"}` });
    stroke.style.borderColor = colours()[shade];
    return element("li", {}, stroke, ...marked(words));
  };
  return element("div", { className: "chart-head" }, element("strong", {}, ...marked(label)), element("ul", {}, ...all.map(entry)));
}

const FONT = "11px system-ui, sans-serif";
/** Height of the title of the time below the last chart. */
const TITLE = 15;

// The options of the chart of some columns; its ranges are those of the motion that `charts` shows.
function options(label, all, charts, width, isLast) {
  const shades = colours();
  const axis = { stroke: shades.faint, grid: { stroke: shades.line, width: 0.5 }, ticks: { stroke: shades.line, size: 4 }, font: FONT, labelFont: FONT, labelSize: TITLE, gap: 3, values: (_, all) => all.map((it) => (it === null ? "" : short(it))) };
  const title = isLast ? { label: "Time (s)", labelGap: 0 } : {};
  return {
    width, height: height() + (isLast ? TITLE : 0) - 18, padding: [8, 14, 0, 0], cursor: { y: false, drag: { x: false, y: false }, sync: { key: charts.synced }, points: { size: 6 } }, legend: { show: false },
    scales: { x: { time: false, range: () => charts.scales["Time (s)"] }, y: { range: () => charts.scales[label] } },
    axes: [{ ...axis, ...title, size: 22, space: 62 }, { ...axis, size: 42, space: 22 }],
    series: [{}, ...all.map(([, , shade, , dash]) => ({ stroke: shades[shade], width: 1.6, dash, points: { show: false } }))],
  };
}

const read = (_, value) => (value === null || value === undefined ? "–" : short(value, 4));

// The values at a place of a canvas with a frame.
function beside(event, canvas, axes) {
  const box = canvas.getBoundingClientRect(), at = valuesAt(canvas, event.clientX - box.left, event.clientY - box.top);
  if (!at) return tip.hide();
  const [[head, text], row] = [0, 1].map((i) => tip.pair(axes[i].label, short(at[i], 4)));
  tip.show(event, { head: `${head} ${text}`, rows: [row] });
}

function ring(drawn, x, y, radius) {
  drawn.beginPath();
  drawn.arc(x, y, radius, 0, 2 * Math.PI);
}

function drawPortrait(canvas, { history, portrait: points }, scales) {
  const made = context(canvas);
  if (!made.width) return;
  const { drawn } = made, area = room(made), shades = colours(), [xs, ys] = portrait(history), [x, y] = model.portrait, stop = surface(history);
  const place = frame(drawn, area, { range: scales.x, label: x.label }, { range: scales.y, label: y.label });
  within(drawn, area, () => {
    if (stop !== null) {
      [drawn.strokeStyle, drawn.lineWidth] = [shades.ink, 1];
      drawn.setLineDash([5, 4]);
      drawn.beginPath(); drawn.moveTo(place.x(stop), area.top); drawn.lineTo(place.x(stop), area.bottom); drawn.stroke();
      drawn.setLineDash([]);
    }
    [drawn.strokeStyle, drawn.lineWidth] = [shades.first, 1.4];
    drawn.beginPath();
    xs.forEach((it, i) => drawn.lineTo(place.x(it), place.y(ys[i])));
    drawn.stroke();
  });
  // Rings at the frame are not cut off.
  [drawn.strokeStyle, drawn.fillStyle, drawn.lineWidth] = [shades.second, shades.paper, 1.5];
  for (const at of points) { ring(drawn, place.x(at[0] * x.factor), place.y(at[1] * y.factor), 3.2); drawn.fill(); drawn.stroke(); }
}

function drawSection(canvas, it, scales) {
  const made = context(canvas);
  if (!made.width || it.isEarly) return;
  const { drawn } = made, area = room(made), [xs, ys] = section(it), [x, y] = model.section;
  const place = frame(drawn, area, { range: scales.sx, label: x.label }, { range: scales.sy, label: y.label });
  drawn.fillStyle = colours().second;
  xs.forEach((it, i) => { ring(drawn, place.x(it), place.y(ys[i]), xs.length > 20 ? 1.6 : 3.2); drawn.fill(); });
}
