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

/** Ranges that hold all motions; none where no motion has a history. */
export function common(motions) {
  const all = motions.filter(({ history }) => history).map(ranges);
  if (!all.length) return null;
  const ends = (key) => [Math.min(...all.map((it) => it[key][0])), Math.max(...all.map((it) => it[key][1]))];
  return Object.fromEntries(Object.keys(all[0]).map((key) => [key, ends(key)]));
}

/** The charts of a motion in a place that is on the page; `scales` are ranges to keep to, or none for its own. */
export function charts(place, it, scales) {
  const { history } = it, own = scales || ranges(it);
  for (const [label, all] of CHARTS) place.append(chart(place, history, label, columns(history, all), own));
  const canvas = (words) => element("canvas", { className: "portrait", role: "img", ariaLabel: words });
  const [x, y] = portrait(history), ends = (values) => range(values, 0).map((value) => short(value, 4)).join(" to ");
  const first = canvas(`Phase portrait: x1 − x2 from ${ends(x)} mm, y1 − y2 from ${ends(y)} mm/s, the stop at ${short(history.delta * MM)} mm`);
  const second = canvas(`Stroboscopic section: ${it.stroboscopic.length} points; the table of section points has them`);
  place.append(element("div", { className: "portraits" }, first, second));
  redrawn(first, () => drawPortrait(first, it, own));
  redrawn(second, () => drawSection(second, it, own));
}

function chart(place, history, label, shown, scales) {
  const shades = colours(), data = [history.t, ...shown.map((column) => scaled(history, column))];
  const axis = { stroke: shades.ink, grid: { stroke: shades.line, width: 0.5 }, ticks: { stroke: shades.faint, size: 4 }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" };
  const ends = shown.map(([, words], i) => `${words} from ${range(data[i + 1], 0).map((value) => short(value, 4)).join(" to ")}`);
  const words = `${label} over ${history.cycles} cycles, ${short(history.t.at(-1), 4)} s: ${ends.join(", ")}`;
  const holder = element("div", { role: "img", ariaLabel: words, className: "chart" });
  const options = {
    width: Math.max(place.clientWidth, 200), height: HEIGHT,
    padding: [10, 16, 0, 0],
    cursor: { y: false, drag: { x: false, y: false } },
    scales: { x: { time: false, range: scales["Time (s)"] }, y: { range: scales[label] } },
    axes: [{ ...axis, label: "Time (s)", labelSize: 16, size: 26, labelGap: 0 }, { ...axis, label, size: 52, labelSize: 16 }],
    series: [{ label: "t (s)", value: read }, ...shown.map(([, name, shade, , dash]) => ({ label: name, stroke: shades[shade], width: 1.6, dash, points: { show: false }, value: read }))],
  };
  const made = new uPlot(options, data, holder);
  new ResizeObserver(() => { if (place.clientWidth && place.clientWidth !== made.width) made.setSize({ width: place.clientWidth, height: HEIGHT }); }).observe(place);
  return holder;
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
    [drawn.strokeStyle, drawn.fillStyle, drawn.lineWidth] = [shades.second, shades.paper, 1.5];
    for (const [r, y1, y2] of stroboscopic) { ring(drawn, place.x(r * MM), place.y((y1 - y2) * MM), 3.2); drawn.fill(); drawn.stroke(); }
  });
}

function drawSection(canvas, it, scales) {
  const made = context(canvas), { drawn } = made, area = room(made), [xs, ys] = section(it);
  const place = frame(drawn, area, { range: scales.sx, label: "Section x1 − x2 (mm)" }, { range: scales.sy, label: "Section y1 (mm/s)" });
  drawn.fillStyle = colours().second;
  within(drawn, area, () => xs.forEach((x, i) => { ring(drawn, place.x(x), place.y(ys[i]), xs.length > 20 ? 1.6 : 3.2); drawn.fill(); }));
}
