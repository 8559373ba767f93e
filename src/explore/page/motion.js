// The motion of a case: histories, phase portrait, section, events and numbers.

import uPlot from "./uPlot.esm.js";
import { colour, context, frame, range, short } from "./plot.js";

const MM = 1e3;
/** The histories: heading, unit, and columns with their names, colours and factors. */
const CHARTS = [
  ["Displacements (mm)", [["r", "x1 − x2", "first", MM], ["x1", "x1", "second", MM], ["x2", "x2", "third", MM]]],
  ["Velocities (mm/s)", [["y1", "y1", "second", MM], ["y2", "y2", "third", MM]]],
  ["Forces (N)", [["drive", "drive", "fourth", 1], ["contact", "contact", "first", 1], ["friction", "friction", "third", 1]]],
];

const element = (name, content = {}, ...children) => {
  const made = Object.assign(document.createElement(name), content);
  made.append(...children);
  return made;
};

/** A panel for the motion `it` with this heading; `remove` is called when it is unpinned, `pin` when it is pinned. */
export function panel(it, heading, { pin, remove }) {
  const button = element("button", { type: "button", textContent: remove ? "Unpin" : "Pin to compare" });
  button.addEventListener("click", remove || pin);
  const charts = element("div", { className: "charts" });
  const place = element("article", { className: "motion" }, element("h3", { textContent: heading }), summary(it), button, charts);
  queueMicrotask(() => draw(it, charts));
  charts.after(...tables(it));
  return place;
}

// What it settles to, in a sentence.
function summary(it) {
  const { orbit } = it.simulate;
  const speed = orbit.progression_speed === null ? "" : `, ${short(orbit.progression_speed * MM)} mm/s`;
  const kind = orbit.outcome === "periodic" ? `periodic, period ${orbit.period}` : orbit.outcome;
  const start = `Starts ${it.start}${it.exact ? ` (case ${it.nearest})` : `; nearest case ${it.nearest}`}.`;
  const about = element("div", {}, element("p", { textContent: `${kind}${speed}. ${start}` }));
  it.remarks.forEach((remark) => about.append(element("p", { textContent: remark })));
  if (orbit.failure) about.append(element("p", { textContent: `Failed: ${orbit.failure}` }));
  return about;
}

function draw(it, charts) {
  const { history } = it;
  if (!history) return;
  for (const [title, columns] of CHARTS) {
    const shown = columns.filter(([name]) => history[name]);
    const data = [history.t, ...shown.map(([name, , , factor]) => history[name].map((value) => value * factor))];
    const axis = { stroke: colour("ink"), grid: { stroke: colour("line"), width: 0.5 }, ticks: { stroke: colour("line") } };
    const options = {
      title, width: charts.clientWidth, height: 190,
      scales: { x: { time: false } },
      axes: [{ ...axis, label: "Time (s)", labelSize: 18 }, { ...axis, size: 60 }],
      series: [{ label: "t (s)" }, ...shown.map(([, label, shade]) => ({ label, stroke: colour(shade), width: 1.5, points: { show: false } }))],
    };
    const place = element("div", { role: "img", ariaLabel: `${title} over time, ${history.cycles} cycles` });
    charts.append(place);
    const chart = new uPlot(options, data, place);
    new ResizeObserver(() => chart.setSize({ width: charts.clientWidth, height: 190 })).observe(charts);
  }
  const portrait = element("canvas", { className: "portrait", role: "img", ariaLabel: "Phase portrait: relative velocity over relative displacement" });
  const section = element("canvas", { className: "portrait", role: "img", ariaLabel: "Stroboscopic section: velocity of the mass over relative displacement" });
  charts.append(portrait, section);
  new ResizeObserver(() => { drawPortrait(portrait, history); drawSection(section, it); }).observe(charts);
}

const area = ({ width, height }) => ({ left: 66, top: 8, right: width - 10, bottom: height - 40 });

function drawPortrait(canvas, { r, y1, y2, delta }) {
  const made = context(canvas), { drawn } = made, box = area(made);
  const [xs, ys] = [r.map((value) => value * MM), y1.map((value, i) => (value - y2[i]) * MM)];
  const place = frame(drawn, box, { range: range([...xs, delta * MM]), label: "x1 − x2 (mm)" }, { range: range(ys), label: "y1 − y2 (mm/s)" });
  drawn.setLineDash([4, 3]);
  drawn.beginPath(); drawn.moveTo(place.x(delta * MM), box.top); drawn.lineTo(place.x(delta * MM), box.bottom); drawn.stroke();
  drawn.setLineDash([]);
  drawn.strokeStyle = colour("first"); drawn.lineWidth = 1.3;
  drawn.beginPath();
  xs.forEach((x, i) => drawn.lineTo(place.x(x), place.y(ys[i])));
  drawn.stroke();
}

function drawSection(canvas, { stroboscopic }) {
  const made = context(canvas), { drawn } = made;
  const [xs, ys] = [stroboscopic.map((it) => it[0] * MM), stroboscopic.map((it) => it[1] * MM)];
  const place = frame(drawn, area(made), { range: range(xs), label: "Stroboscopic x1 − x2 (mm)" }, { range: range(ys), label: "Stroboscopic y1 (mm/s)" });
  drawn.fillStyle = colour("first");
  xs.forEach((x, i) => { drawn.beginPath(); drawn.arc(place.x(x), place.y(ys[i]), 2.5, 0, 2 * Math.PI); drawn.fill(); });
}

const row = (cells, isHead) => {
  const made = element("tr");
  cells.forEach((cell) => made.append(element(isHead ? "th" : "td", {
    textContent: cell, className: typeof cell === "number" || /^[−\d]/.test(cell) ? "number" : "",
  })));
  return made;
};

function table(heading, head, rows) {
  const body = element("table", {}, row(head, true));
  rows.forEach((cells) => body.append(row(cells, false)));
  const place = element("div", { className: "scroll", tabIndex: 0, role: "region", ariaLabel: heading }, body);
  return element("details", {}, element("summary", { textContent: heading }), place);
}

function tables({ simulate }) {
  const { orbit, events, parameters } = simulate;
  const numbers = Object.entries(orbit).filter(([, value]) => typeof value === "number" || value === null);
  const multipliers = (orbit.multipliers || []).map(([re, im], i) => [`multiplier ${i + 1}`, re === null ? "not known" : `${short(re)} ${im < 0 ? "−" : "+"} ${short(Math.abs(im))} i`]);
  const listed = events.map((it) => [short(it.t), it.kind, short(it.r * MM), short(it.y1 * MM), short(it.x2 * MM), short(it.y2 * MM)]);
  return [
    table("Numbers of the orbit (SI)", ["output", "value"], [...numbers.map(([name, value]) => [name, value === null ? "none" : String(value)]), ...multipliers]),
    table(`Events from the start (${events.length})`, ["t (s)", "event", "r (mm)", "y1 (mm/s)", "x2 (mm)", "y2 (mm/s)"], listed),
    table("Parameters (SI)", ["parameter", "value"], Object.entries(parameters).map(([name, value]) => [name, String(value)])),
  ];
}
