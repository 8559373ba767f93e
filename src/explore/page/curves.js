// Special points and branches over the map, with their legend and tables.

import { element, folded } from "./element.js";
import { rimmed } from "./marks.js";
import { short } from "./ticks.js";

// The colour of a curve or a point; black where it has none of its own.
const ink = ({ colour }) => `rgb(${colour || [0, 0, 0]})`;
// A rim that stands out from it.
const rim = ({ colour }) => {
  const [r, g, b] = colour || [0, 0, 0];
  return 0.3 * r + 0.59 * g + 0.11 * b > 150 ? "#000000" : "#ffffff";
};

/** The shape of each special point, about a place. */
const SHAPES = {
  "fold": (drawn, [x, y], r) => polygon(drawn, [[x, y - r], [x + r, y + r * 0.8], [x - r, y + r * 0.8]]),
  "period doubling": (drawn, [x, y], r) => polygon(drawn, [[x, y - r], [x + r, y], [x, y + r], [x - r, y]]),
  "Neimark–Sacker": (drawn, [x, y], r) => polygon(drawn, Array.from({ length: 10 }, (_, i) => {
    const [far, turn] = [i % 2 ? r * 0.45 : r * 1.2, i * Math.PI / 5];
    return [x + far * Math.sin(turn), y - far * Math.cos(turn)];
  })),
  "grazing": (drawn, [x, y], r) => { drawn.moveTo(x + r, y); drawn.arc(x, y, r, 0, 2 * Math.PI); },
};

function polygon(drawn, corners) {
  corners.forEach((corner, i) => (i ? drawn.lineTo(...corner) : drawn.moveTo(...corner)));
  drawn.closePath();
}

// The shape whose name is in the words of a point; a square for others.
function shape(words) {
  const found = Object.entries(SHAPES).find(([name]) => words.includes(name));
  return found ? found[1] : (drawn, [x, y], r) => drawn.rect(x - r * 0.8, y - r * 0.8, 1.6 * r, 1.6 * r);
}

/** Draws a special point, by its words, in its own colours or in others. */
export function point(drawn, at, it, radius = 5, inside = ink(it), around = rim(it)) {
  drawn.beginPath();
  shape(it.words)(drawn, at, radius);
  drawn.fillStyle = inside;
  drawn.fill();
  [drawn.lineWidth, drawn.strokeStyle] = [1.2, around];
  drawn.stroke();
}

function curve(drawn, places, it) {
  const path = () => places.forEach(([x, y], i) => (i ? drawn.lineTo(x, y) : drawn.moveTo(x, y)));
  drawn.lineJoin = "round";
  drawn.setLineDash(it.dash ? [6, 4] : []);
  rimmed(drawn, path, ink(it), 1.8, rim(it));
  drawn.setLineDash([]);
}

// The sequence of events changes at many points: other symbols lie over those, and folds and period doublings over all.
const order = ({ words }) => (/fold|period doubling/.test(words) ? 2 : /event/.test(words) ? 0 : 1);

/** Special points in the order in which they are drawn. */
export const ordered = (points) => [...points].sort((a, b) => order(a) - order(b));

/** What draws curves and points over a map: `to` takes places in the units shown, and `put` draws at one that is seen. */
export const layer = ({ lines, points }) => {
  const sorted = ordered(points);
  return {
    lines: (drawn, to) => lines.forEach((it) => curve(drawn, it.points.map(([x, y]) => to(x, y)), it)),
    points: (drawn, put) => sorted.forEach((it) => put(...it.at, (_, at) => point(drawn, at, it))),
  };
};

/** Those of the curves and points that are seen on a map. */
export function seen({ lines, points }, map) {
  const isLine = ({ points: all }) => all.some((it, i) => i && map.crosses(map.shown(...all[i - 1]), map.shown(...it)));
  return { lines: lines.filter(isLine), points: points.filter((it) => map.isSeen(map.shown(...it.at))) };
}

// One of each kind, by its words, colour and dashes.
const kinds = (all) => [...new Map(all.map((it) => [JSON.stringify([it.words, it.colour, it.dash]), it])).values()];

/** The entries of the legend of the map, as `entry` makes them. */
export function entries({ lines, points }, entry) {
  return [
    ...kinds(lines).map((it) => entry(it.words, (drawn, [x, y]) => curve(drawn, [[x - 12, y], [x + 12, y]], it))),
    ...kinds(points).map((it) => entry(it.words, (drawn, at) => point(drawn, at, it))),
  ];
}

/** The tables of curves and points, and what is left out. */
export function tables({ lines, points, left_out: out }, { x, y }) {
  const made = element("div", { id: "curves" });
  if (!lines.length && !points.length) made.append(element("p", { className: "note", textContent: "No special point or branch lies over these two axes." }));
  if (out) made.append(element("p", { className: "note", textContent: `Left out: ${out}` }));
  if (points.length) {
    const rows = () => points.map((it) => [it.words, short(it.at[0]), short(it.at[1])]);
    made.append(folded(`Special points (${points.length})`, ["point", x.label, y.label], rows));
  }
  if (lines.length) {
    const end = ([a, b]) => `(${short(a)}, ${short(b)})`;
    const rows = () => lines.map((it) => [it.words, String(it.points.length), end(it.points[0]), end(it.points.at(-1))]);
    made.append(folded(`Branches and curves (${lines.length})`, ["branch or curve", "points", "from", "to"], rows));
  }
  return made;
}
