// Marks over a plane, each with a rim so that it is seen on every colour.

import { colours } from "./plot.js";

const RIM = "#ffffff";
const INK = "#000000";
const LINE = "#c8003c";

/** Draws a path twice: its rim and itself. */
export function rimmed(drawn, path, shade, width = 2, rim = RIM) {
  for (const [line, tone] of [[width + 2.5, rim], [width, shade]]) {
    drawn.lineWidth = line;
    drawn.strokeStyle = tone;
    drawn.beginPath();
    path();
    drawn.stroke();
  }
}

/** The mark of the chosen case. */
export function cross(drawn, [x, y]) {
  rimmed(drawn, () => {
    drawn.arc(x, y, 6, 0, 2 * Math.PI);
    for (const [right, down] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      drawn.moveTo(x + 4 * right, y + 4 * down);
      drawn.lineTo(x + 12 * right, y + 12 * down);
    }
  }, INK);
}

/** A letter in a ring, for a pinned case. */
export function letter(drawn, [x, y], text) {
  drawn.beginPath();
  drawn.arc(x, y, 8, 0, 2 * Math.PI);
  drawn.fillStyle = RIM;
  drawn.fill();
  drawn.lineWidth = 1.5;
  drawn.strokeStyle = INK;
  drawn.stroke();
  drawn.fillStyle = INK;
  drawn.textAlign = "center";
  drawn.textBaseline = "middle";
  drawn.fillText(text, x, y + 0.5);
}

/** A line, with a ring where it begins and a disc where it ends. */
export function line(drawn, [from, to]) {
  rimmed(drawn, () => { drawn.moveTo(...from); drawn.lineTo(...to); }, LINE);
  dot(drawn, to, LINE, 4);
  rimmed(drawn, () => drawn.arc(...from, 3.5, 0, 2 * Math.PI), LINE, 1.5);
}

/** A rectangle between two of its corners. */
export function rectangle(drawn, [from, to]) {
  drawn.setLineDash([6, 4]);
  rimmed(drawn, () => drawn.rect(from[0], from[1], to[0] - from[0], to[1] - from[1]), INK, 1.5);
  drawn.setLineDash([]);
}

/** A dot with a rim. */
export function dot(drawn, [x, y], shade, radius = 3.5, rim = RIM) {
  drawn.beginPath();
  drawn.arc(x, y, radius, 0, 2 * Math.PI);
  drawn.fillStyle = shade;
  drawn.fill();
  drawn.lineWidth = 1;
  drawn.strokeStyle = rim;
  drawn.stroke();
}

/** A section point in the colour of its attractor, within black, so that it is seen on the basin of the same colour. */
export function sectionPoint(drawn, place, shade) {
  dot(drawn, place, INK, 6);
  dot(drawn, place, shade, 3.5);
}

/** A section point of a saddle: a ring, as it belongs to no basin. */
export function saddle(drawn, place) {
  dot(drawn, place, RIM, 6);
  rimmed(drawn, () => drawn.arc(...place, 4.5, 0, 2 * Math.PI), INK, 2);
}

/** Curves of manifolds: the boundary of basins, and the dashed unstable ones. */
export function manifold(drawn, places, isStable) {
  drawn.setLineDash(isStable ? [] : [7, 3, 1.5, 3]);
  drawn.lineJoin = "round";
  for (const [width, tone] of [[3, "#ffffffa0"], [1.3, INK]]) {
    [drawn.lineWidth, drawn.strokeStyle] = [width, tone];
    drawn.beginPath();
    places.forEach((at, i) => drawn[i ? "lineTo" : "moveTo"](...at));
    drawn.stroke();
  }
  drawn.setLineDash([]);
}

/** Dots that are more than this have no rims and are smaller: rims would hide what lies under them. */
const MANY = 60;

/** Dots as places with their colours, all rims under all dots. */
export function dots(drawn, all, rim = RIM) {
  const radius = all.length > MANY ? 2.2 : 3.5;
  const disc = ([x, y], shade, size) => { drawn.beginPath(); drawn.arc(x, y, size, 0, 2 * Math.PI); drawn.fillStyle = shade; drawn.fill(); };
  if (all.length <= MANY) all.forEach(([place]) => disc(place, rim, radius + 1));
  all.forEach(([place, shade]) => disc(place, shade, radius));
}

/** The mark of the keyboard, where no case is chosen. */
export function cursor(drawn, [x, y]) {
  rimmed(drawn, () => drawn.rect(x - 6, y - 6, 12, 12), INK, 1.5);
}

/** An entry of a legend: a small picture that `draw` draws about the middle of a canvas, and its words. */
export function entry(text, draw) {
  const made = document.createElement("li"), canvas = document.createElement("canvas"), ratio = window.devicePixelRatio || 1;
  [canvas.width, canvas.height] = [28 * ratio, 20 * ratio];
  canvas.setAttribute("aria-hidden", "true");
  const drawn = canvas.getContext("2d");
  drawn.scale(ratio, ratio);
  drawn.font = "12px system-ui, sans-serif";
  draw(drawn, [14, 10]);
  made.append(canvas, text);
  return made;
}

/** The colours of the fronts: forward and backward. */
export const front = (direction) => colours()[direction === "forward" ? "second" : "first"];
