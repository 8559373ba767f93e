// The charts of a motion: histories, phase portrait and stroboscopic section.

import uPlot from "./uPlot.esm.js";
import { element } from "./element.js";
import { colours, context, frame, redrawn, room, within } from "./plot.js";
import { range, short } from "./ticks.js";

const MM = 1e3;
const HEIGHT = 170;
/** The histories: label, and columns with their names, colours, factors and dashes. */
const CHARTS = [
  ["Displacement (mm)", [["r", "x1 − x2", "first", MM], ["x1", "x1", "second", MM, [7, 3]], ["x2", "x2", "third", MM, [2, 3]]]],
  ["Velocity (mm/s)", [["y1", "y1", "second", MM], ["y2", "y2", "third", MM, [7, 3]]]],
  ["Force (N)", [["drive", "drive", "fourth", 1, [7, 3]], ["contact", "contact", "first", 1], ["friction", "friction", "third", 1, [2, 3]]]],
];

const columns = (history, all) => all.filter(([name]) => history[name]);
const scaled = (history, [name, , , factor]) => history[name].map((value) => value * factor);

// Relative displacement and velocity.
const portrait = ({ r, y1, y2 }) => [r.map((value) => value * MM), y1.map((value, i) => (value - y2[i]) * MM)];
const section = ({ stroboscopic }) => [0, 1].map((i) => stroboscopic.map((it) => it[i] * MM));

/** The ranges of everything that is drawn of a motion, by the name of its axis. */
function ranges(it) {
  const made = { "Time (s)": [0, it.history.t.at(-1)] };
  for (const [label, all] of CHARTS) made[label] = range(columns(it.history, all).flatMap((column) => scaled(it.history, column)));
  const [x, y] = portrait(it.history), [sx, sy] = section(it);
  return { ...made, x: range([...x, it.history.delta * MM]), y: range(y), sx: range(sx), sy: range(sy) };
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
    Object.assign(this, { place, plots: [], it: null });
    this.canvases = [0, 1].map(() => element("canvas", { className: "portrait", role: "img" }));
    this.portraits = element("div", { className: "portraits" }, ...this.canvases);
    const all = [drawPortrait, drawSection];
    this.canvases.forEach((canvas, i) => redrawn(canvas, () => this.it && all[i](canvas, this.it, this.scales)));
    new ResizeObserver(() => this.fit()).observe(place);
  }

  /** Shows a motion with a history; `scales` are ranges to keep to, or none for its own. */
  show(it, scales) {
    Object.assign(this, { it, scales: scales || ranges(it) });
    const shown = CHARTS.map(([label, all]) => [label, columns(it.history, all)]), key = JSON.stringify([shown, colours()]);
    if (key !== this.key) this.build(shown);
    this.key = key;
    shown.forEach(([label, all], i) => this.fill(this.plots[i], label, all));
    this.describe();
    drawPortrait(this.canvases[0], it, this.scales);
    drawSection(this.canvases[1], it, this.scales);
  }

  build(shown) {
    this.plots.forEach(({ plot }) => plot.destroy());
    this.plots = shown.map(([label, all]) => {
      const holder = element("div", { role: "img", className: "chart" });
      return { holder, plot: new uPlot(options(label, all, this, Math.max(this.place.clientWidth, 200)), null, holder) };
    });
    this.place.replaceChildren(...this.plots.map(({ holder }) => holder), this.portraits);
  }

  fill({ plot, holder }, label, all) {
    const { history } = this.it, data = [history.t, ...all.map((column) => scaled(history, column))];
    const ends = all.map(([, words], i) => `${words} from ${range(data[i + 1], 0).map((value) => short(value, 4)).join(" to ")}`);
    holder.setAttribute("aria-label", `${label} over ${history.cycles} cycles, ${short(history.t.at(-1), 4)} s: ${ends.join(", ")}`);
    plot.setData(data);
  }

  describe() {
    const { history, stroboscopic } = this.it, [x, y] = portrait(history), ends = (values) => range(values, 0).map((value) => short(value, 4)).join(" to ");
    const words = [
      `Phase portrait: x1 − x2 from ${ends(x)} mm, y1 − y2 from ${ends(y)} mm/s, the stop at ${short(history.delta * MM)} mm`,
      `Stroboscopic section: ${stroboscopic.length} points; the table of section points has them`,
    ];
    this.canvases.forEach((canvas, i) => canvas.setAttribute("aria-label", words[i]));
  }

  fit() {
    const width = this.place.clientWidth;
    for (const { plot } of this.plots) if (width && width !== plot.width) plot.setSize({ width, height: HEIGHT });
  }

  /** Shows nothing. */
  clear() {
    Object.assign(this, { it: null, key: null });
    this.place.replaceChildren();
  }
}

// The options of the chart of some columns; its ranges are those of the motion that `charts` shows.
function options(label, all, charts, width) {
  const shades = colours(), font = "12px system-ui, sans-serif";
  const axis = { stroke: shades.ink, grid: { stroke: shades.line, width: 0.5 }, ticks: { stroke: shades.faint, size: 4 }, font, labelFont: font, labelSize: 16, values: (_, all) => all.map((it) => (it === null ? "" : short(it))) };
  const border = (dash) => (dash ? (dash[0] > 4 ? "dashed" : "dotted") : "solid");
  return {
    width, height: HEIGHT, padding: [10, 16, 0, 0], cursor: { y: false, drag: { x: false, y: false } },
    scales: { x: { time: false, range: () => charts.scales["Time (s)"] }, y: { range: () => charts.scales[label] } },
    axes: [{ ...axis, label: "Time (s)", size: 26, labelGap: 0 }, { ...axis, label, size: 52 }],
    legend: { markers: { width: 2, dash: (_, i) => border(all[i - 1]?.[4]) } },
    series: [{ label: "t (s)", value: read }, ...all.map(([, name, shade, , dash]) => ({ label: name, stroke: shades[shade], width: 1.6, dash, points: { show: false }, value: read }))],
  };
}

const read = (_, value) => (value === null || value === undefined ? "–" : short(value, 4));

function ring(drawn, x, y, radius) {
  drawn.beginPath();
  drawn.arc(x, y, radius, 0, 2 * Math.PI);
}

function drawPortrait(canvas, { history, stroboscopic }, scales) {
  const made = context(canvas), { drawn } = made, area = room(made), shades = colours(), [xs, ys] = portrait(history);
  const place = frame(drawn, area, { range: scales.x, label: "x1 − x2 (mm)" }, { range: scales.y, label: "y1 − y2 (mm/s)" });
  within(drawn, area, () => {
    [drawn.strokeStyle, drawn.lineWidth] = [shades.ink, 1];
    drawn.setLineDash([5, 4]);
    drawn.beginPath(); drawn.moveTo(place.x(history.delta * MM), area.top); drawn.lineTo(place.x(history.delta * MM), area.bottom); drawn.stroke();
    drawn.setLineDash([]);
    [drawn.strokeStyle, drawn.lineWidth] = [shades.first, 1.4];
    drawn.beginPath();
    xs.forEach((x, i) => drawn.lineTo(place.x(x), place.y(ys[i])));
    drawn.stroke();
  });
  // Rings at the frame are not cut off.
  [drawn.strokeStyle, drawn.fillStyle, drawn.lineWidth] = [shades.second, shades.paper, 1.5];
  for (const [r, y1, y2] of stroboscopic) { ring(drawn, place.x(r * MM), place.y((y1 - y2) * MM), 3.2); drawn.fill(); drawn.stroke(); }
}

function drawSection(canvas, it, scales) {
  const made = context(canvas), { drawn } = made, area = room(made), [xs, ys] = section(it);
  const place = frame(drawn, area, { range: scales.sx, label: "Section x1 − x2 (mm)" }, { range: scales.sy, label: "Section y1 (mm/s)" });
  drawn.fillStyle = colours().second;
  xs.forEach((x, i) => { ring(drawn, place.x(x), place.y(ys[i]), xs.length > 20 ? 1.6 : 3.2); drawn.fill(); });
}
