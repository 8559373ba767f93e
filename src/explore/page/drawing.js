// How the bifurcation diagram of a file is drawn: its points, lines, symbols and legend.

import * as curves from "./curves.js";
import { element, parted } from "./element.js";
import { entry } from "./marks.js";
import { colours } from "./plot.js";
import { short } from "./ticks.js";

const square = (drawn, x, y, r) => drawn.fillRect(x - r, y - r, 2 * r, 2 * r);
const light = ([r, g, b]) => 0.3 * r + 0.59 * g + 0.11 * b;
const isDark = () => light(colours().paper.match(/[\da-f]{2}/gi).map((it) => parseInt(it, 16))) < 128;
/** A colour of the figures, which are on white: what is nearly black there has the colour of the text here. */
export const shade = (rgb) => (isDark() && light(rgb) < 60 ? colours().ink : `rgb(${rgb})`);
/** A special point in the colours of the text and the paper, as points have colours of their own; the shapes are those of the figure. */
export function symbol(drawn, [x, y], words, radius = 4.5) {
  const { ink, paper } = colours(), isHollow = /grazing|unresolved/.test(words), r = 0.7 * radius;
  if (words !== "event sequence") return curves.point(drawn, [x, y], { words }, radius, ...(isHollow ? [paper, ink] : [ink, paper]));
  for (const [line, tone] of [[3.5, paper], [1.4, ink]]) {
    [drawn.lineWidth, drawn.strokeStyle] = [line, tone];
    drawn.beginPath(); drawn.moveTo(x - r, y - r); drawn.lineTo(x + r, y + r); drawn.moveTo(x - r, y + r); drawn.lineTo(x + r, y - r); drawn.stroke();
  }
}

/** Draws what lies within the frame of a panel: points of a size, ramps and the lines of branches. */
export function paint(drawn, data, { panel, number }, place, area, size) {
  const { cases, sorts, windows, ramps, x } = data, shades = colours();
  drawn.fillStyle = "#80808026";
  for (const [from, to] of windows) drawn.fillRect(place.x(from), area.top, place.x(to) - place.x(from), area.bottom - area.top);
  const [low, high] = data.panels[number].section ? [1, -1] : [place.y(0), place.y(0)];
  if (low === high && low > area.top && low < area.bottom) { drawn.fillStyle = shades.line; drawn.fillRect(area.left, low - 0.5, area.right - area.left, 1); }
  const looks = sorts.map(([, colour]) => shade(colour));
  cases.forEach((it, i) => {
    if (it.sort === null) return;
    const across = place.x(it.at[0] * x.factor);
    if (across < area.left - 2 || across > area.right + 2) return;
    drawn.fillStyle = data.by ? it.colour ? shade(it.colour) : shades.faint : looks[it.sort];
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

/** The special points of a panel, each with where it is: those of the branches and those of the attractors of the sweeps. */
export function marked(data, { panel, number }) {
  const ofBranches = data.special.flatMap((it) => it.values[number].map((value) => ({ ...it, at: [it.x, value] })));
  return [...panel.events, ...ofBranches];
}

/** Whether there are lines of a stability, or of any. */
export function hasLines(data, kind) {
  const has = (it) => data.panels.some((panel) => panel[it].some((line) => line.length > 1));
  return kind ? has(kind) : has("stable") || has("unstable");
}

/** The entries of the legend for what is seen: panels and a part of the abscissa, and where the motion is that is shown, if it is there. */
export function entries(data, panels, [low, high], chosenAt) {
  const { sorts, cases, by: paint, ramps, windows, x } = data, made = [], shades = colours();
  const isIn = (at) => at >= low && at <= high, inside = cases.filter((it) => it.sort !== null && isIn(it.at[0] * x.factor));
  const disc = (colour, r = 3) => (drawn, [at, y]) => { drawn.fillStyle = colour; square(drawn, at, y, r); };
  if (paint) made.push(element("li", { textContent: `${parted(paint.told)[0]}:` }));
  if (paint?.key.kinds) for (const [name, colour] of paint.key.kinds) made.push(entry(name, disc(colour ? shade(colour) : shades.faint)));
  else if (paint) made.push(entry(`from ${short(paint.key.range[0], 4)} to ${short(paint.key.range[1], 4)} ${parted(paint.told)[1]}`, (drawn, [at, y]) => {
    const all = paint.key.colours, step = 26 / all.length;
    all.forEach((rgb, i) => { drawn.fillStyle = `rgb(${rgb})`; drawn.fillRect(at - 13 + i * step, y - 4, step + 0.6, 8); });
  }));
  else sorts.forEach(([name, colour], sort) => { if (inside.some((it) => it.sort === sort) && (sorts.length > 1 || hasLines(data))) made.push(entry(sorts.length > 1 ? name : "settled", disc(shade(colour)))); });
  if (windows.some(([from, to]) => to > low && from < high)) made.push(entry("coexistence", (drawn, [at, y]) => { drawn.fillStyle = "#80808040"; drawn.fillRect(at - 12, y - 7, 24, 14); }));
  const line = (dashes, width) => (drawn, [at, y]) => {
    drawn.setLineDash(dashes);
    [drawn.strokeStyle, drawn.lineWidth] = [shades.ink, width];
    drawn.beginPath(); drawn.moveTo(at - 13, y); drawn.lineTo(at + 13, y); drawn.stroke();
  };
  if (hasLines(data, "stable")) made.push(entry("stable orbits", line([], 1.4)));
  if (hasLines(data, "unstable")) made.push(entry("unstable orbits", line([4, 3], 1.2)));
  const kinds = new Set(panels.flatMap((one) => marked(data, one)).filter(({ at }) => isIn(at[0])).map(({ words }) => words));
  for (const words of kinds) made.push(entry(words, (drawn, at) => symbol(drawn, at, words)));
  for (const it of ramps) made.push(entry(it.name, disc(shade(it.colour), 2.5)));
  if (ramps.some((it) => it.jumps.length)) made.push(entry("jump", line([3, 3], 1)));
  if (chosenAt !== null) made.push(entry("chosen motion", (drawn, [at, y]) => { [drawn.strokeStyle, drawn.lineWidth] = [shades.mark, 1.4]; drawn.beginPath(); drawn.moveTo(at, y - 8); drawn.lineTo(at, y + 8); drawn.stroke(); }));
  return made;
}
