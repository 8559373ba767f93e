// Curves and points over two axes on a canvas, with ticks; uPlot draws what runs over time.

import { parted, runs } from "./element.js";
import { short, texts, ticks } from "./ticks.js";

const NAMES = ["paper", "ink", "faint", "line", "panel", "first", "second", "third", "fourth", "mark"];
const FONT = "12px system-ui, sans-serif";
/** Sizes of text and of an index, and the least part of them that can be read [CSS pixels]. */
const [SIZE, INDEX_SIZE, LEAST] = [12, 9, 0.75];
const drawings = new Map();
let known = null;

/** The colours of the page by their names. */
export function colours() {
  const style = known || getComputedStyle(document.documentElement);
  known ??= Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
  return known;
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  known = null;
  for (const [key, draw] of drawings) {
    if (key instanceof HTMLElement && !key.isConnected) drawings.delete(key);
    else draw();
  }
});

/** Calls `draw` where the colours of the page change; `key` is an element, while it is there, or a name. */
export const recoloured = (key, draw) => drawings.set(key, draw);

/** The sizes of canvases as they were laid out last: to ask for one lays the page out, which takes longer than drawing. */
const sizes = new WeakMap();

/** The size of a canvas [CSS pixels]. */
export const sizeOf = (canvas) => sizes.get(canvas) ?? canvas.getBoundingClientRect();

/** Calls `draw` where the size of a canvas or the colours of the page change. */
export function redrawn(canvas, draw) {
  new ResizeObserver(([{ contentRect: { width, height } }]) => { sizes.set(canvas, { width, height }); draw(); }).observe(canvas);
  recoloured(canvas, draw);
}

/** A canvas with as many pixels as the screen has, and its context in the units of the page. */
export function context(canvas) {
  const { width, height } = sizeOf(canvas);
  const ratio = window.devicePixelRatio || 1;
  const [across, down] = [width, height].map((length) => Math.max(1, Math.round(length * ratio)));
  if (canvas.width !== across || canvas.height !== down) [canvas.width, canvas.height] = [across, down];
  const drawn = canvas.getContext("2d");
  drawn.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawn.clearRect(0, 0, width, height);
  drawn.font = FONT;
  return { drawn, width, height, ratio };
}

const font = (isIndex, part) => `${part * (isIndex ? INDEX_SIZE : SIZE)}px system-ui, sans-serif`;

// The parts of a label with their widths.
function measured(drawn, label, part = 1) {
  const parts = runs(label), widths = parts.map(([text, isIndex]) => { drawn.font = font(isIndex, part); return drawn.measureText(text).width; });
  return { parts, widths, part, whole: widths.reduce((sum, it) => sum + it, 0) };
}

// The label as it fits in some pixels: whole, by its symbol with the unit, or smaller.
function fitted(drawn, label, most) {
  const whole = measured(drawn, label);
  if (whole.whole <= most) return whole;
  const [name, unit] = parted(label), symbol = name.split(" ").at(-1);
  const isSymbol = name !== symbol && symbol.length <= 3 && measured(drawn, symbol).whole <= most;
  const text = isSymbol ? `${symbol}${unit && ` (${unit})`}` : label, now = measured(drawn, text);
  return now.whole <= most ? now : measured(drawn, text, Math.max(LEAST, most / now.whole));
}

/** A label with its indices, about a point of the canvas, in as many pixels as there are at most. */
export function words(drawn, label, x, y, align = "center", most = Infinity) {
  const { parts, widths, part, whole } = fitted(drawn, label, most);
  let at = x - { left: 0, center: whole / 2, right: whole }[align];
  drawn.textAlign = "left";
  parts.forEach(([text, isIndex], i) => {
    drawn.font = font(isIndex, part);
    drawn.fillText(text, at, isIndex ? y + 4 : y);
    at += widths[i];
  });
  drawn.font = FONT;
}

/** The same, rotated, upward. */
export function upward(drawn, label, x, y, most = Infinity) {
  drawn.save();
  drawn.translate(x, y);
  drawn.rotate(-Math.PI / 2);
  drawn.textBaseline = "middle";
  words(drawn, label, 0, 0, "center", most);
  drawn.restore();
}

/** Clips what `draw` draws to an area. */
export function within(drawn, area, draw) {
  drawn.save();
  drawn.beginPath();
  drawn.rect(area.left, area.top, area.right - area.left, area.bottom - area.top);
  drawn.clip();
  draw();
  drawn.restore();
}

/** The share of an axis at which a value lies. */
export const share = ({ range: [low, high], log }, value) =>
  log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);

/** The places of values in an area. */
export const places = (area, x, y) => ({
  x: (value) => area.left + share(x, value) * (area.right - area.left),
  y: (value) => area.bottom - share(y, value) * (area.bottom - area.top),
});

/** The room of a frame on a canvas: ticks and labels to its left and below. */
export const room = ({ width, height }) => ({ left: 70, top: 10, right: width - 18, bottom: height - 42 });

/** The last frame of each canvas. */
const framed = new WeakMap();

/** The values at a place within the last frame of a canvas; none beyond it. */
export function valuesAt(canvas, left, top) {
  const { area, x, y } = framed.get(canvas) ?? {};
  if (!area || left < area.left || left > area.right || top < area.top || top > area.bottom) return null;
  const value = ({ range: [low, high], log }, share) => (log ? low * (high / low) ** share : low + share * (high - low));
  return [value(x, (left - area.left) / (area.right - area.left)), value(y, (area.bottom - top) / (area.bottom - area.top))];
}

/** The frame, ticks and labels of a panel; an abscissa without a label and an ordinate that is bare have no numbers. Returns the places of values. */
export function frame(drawn, area, x, y) {
  const place = places(area, x, y), { ink, faint } = colours();
  framed.set(drawn.canvas, { area, x, y });
  drawn.strokeStyle = faint;
  drawn.fillStyle = ink;
  drawn.lineWidth = 1;
  drawn.strokeRect(area.left, area.top, area.right - area.left, area.bottom - area.top);
  across(drawn, area, x, place);
  upwards(drawn, area, y, place);
  return place;
}

// A label whose numbers are counted from an offset, in a unit.
function counted(label, { offset, unit }) {
  if (!offset && !unit) return label;
  const [name, own] = parted(label), whole = [unit, own].filter((it) => it).join(" ");
  const from = offset ? ` ${offset < 0 ? "+" : "−"} ${short(Math.abs(offset), 12)}` : "";
  return `${name}${from}${whole ? ` (${whole})` : ""}`;
}

/** A label may be longer than its axis by this at each end [CSS pixels]. */
const MARGIN = 6;

function across(drawn, area, x, place) {
  const { found, said } = acrossTicks(drawn, area, x, place);
  drawn.textAlign = "center";
  drawn.textBaseline = "top";
  found.values.forEach((value, i) => {
    const at = place.x(value);
    drawn.beginPath(); drawn.moveTo(at, area.bottom); drawn.lineTo(at, area.bottom + 4); drawn.stroke();
    if (x.label) drawn.fillText(said.texts[i], at, area.bottom + 7);
  });
  if (x.label) words(drawn, counted(x.label, said), (area.left + area.right) / 2, area.bottom + 24, "center", area.right - area.left + 2 * MARGIN);
}

/** Room between the texts of neighbours [CSS pixels]. */
const CLEAR = 14;

// Round values across with texts that stand clear of each other: as many as fit.
function acrossTicks(drawn, area, x, place) {
  const wide = (text) => drawn.measureText(text).width;
  for (let most = Math.min(8, Math.max(3, Math.floor((area.right - area.left) / 30)));; most--) {
    const found = ticks(...x.range, x.log, most), at = found.values.map((it) => place.x(it));
    const apart = Math.min(...at.slice(1).map((it, i) => Math.abs(it - at[i])));
    const said = texts(found, (text) => wide(text) < apart - 6);
    const isClear = said.texts.slice(1).every((text, i) => (wide(text) + wide(said.texts[i])) / 2 + CLEAR < Math.abs(at[i + 1] - at[i]));
    if (isClear || most <= 2) return { found, said };
  }
}

function upwards(drawn, area, y, place) {
  const found = ticks(...y.range, y.log, Math.min(8, Math.floor((area.bottom - area.top) / 30)));
  // The numbers end short of the label, which is rotated.
  const said = texts(found, (text) => drawn.measureText(text).width < 44);
  drawn.textAlign = "right";
  drawn.textBaseline = "middle";
  found.values.forEach((value, i) => {
    const at = place.y(value);
    drawn.beginPath(); drawn.moveTo(area.left, at); drawn.lineTo(area.left - 4, at); drawn.stroke();
    if (!y.isBare) drawn.fillText(said.texts[i], area.left - 7, at);
  });
  if (y.isAbove) { drawn.textBaseline = "alphabetic"; words(drawn, counted(y.label, said), area.left, area.top - 6, "left", area.right - area.left); }
  else if (y.label) upward(drawn, counted(y.label, said), area.left - 61, (area.top + area.bottom) / 2, area.bottom - area.top + 2 * MARGIN);
}
