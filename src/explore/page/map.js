// The map: its cells, the marks over them, and the key of its colours.

import { hatch } from "./cells.js";
import { element, parted } from "./element.js";
import { cross, cursor, dot, dots, front, letter, line, manifold, rectangle, saddle, sectionPoint } from "./marks.js";
import { colours, room, sizeOf, upward } from "./plot.js";
import { Plane } from "./plane.js";
import { numbers, share } from "./scale.js";
import { result, short } from "./ticks.js";

const SWATCH = 12;

/** A map on a canvas, as a plane; `marks` has what lies over it: places in SI. */
export class CellMap extends Plane {
  constructor(canvas, on) {
    super(canvas, on);
    this.marks = { pins: [], line: null, rectangle: null, fronts: {}, curves: null, spot: null, attractors: [], saddles: [], manifolds: null };
  }

  /** Shows other cells; the mark and what is seen stay if the axes are the same. */
  show(data) {
    const isSame = this.data && this.data.x.name === data.x.name && this.data.y.name === data.y.name;
    if (!isSame) Object.assign(this, { window: this.data ? null : this.window, mark: null, chosen: null });
    this.keyRoom = keyRoom(this.canvas, data);
    super.show(data);
  }

  /** Sets marks and draws them. */
  set(marks) {
    Object.assign(this.marks, marks);
    if (this.data) this.draw();
  }

  area() {
    const area = room(sizeOf(this.canvas));
    return { ...area, right: Math.max(area.right + 18 - (this.keyRoom || 0), area.left + 60) };
  }

  /** The value of a cell in words. */
  told({ number }) {
    const value = this.data.values[number];
    if (this.data.key.kinds) return this.data.key.kinds[value]?.[0] ?? "no value";
    return Number.isNaN(value) ? "no value" : result(value, parted(this.data.told)[1]);
  }

  /** The colour of a cell; none where it has no value. */
  colour({ number }) {
    const [red, green, blue, opacity] = this.data.colours.slice(4 * number, 4 * number + 4);
    return opacity ? `rgb(${red}, ${green}, ${blue})` : null;
  }

  /** What else is told of a cell, as names and texts. */
  more() { return []; }

  /** The shares of a place in the units shown. */
  shown(x, y) { return [this.share(this.data.x, x), this.share(this.data.y, y)]; }

  ends() { return this.marks.line?.map((it) => this.shares(it)) ?? []; }
  fixed(end) { return this.marks.line[end]; }

  over(drawn, to) {
    const { marks } = this, place = (point) => to(this.shares(point));
    marks.curves?.lines(drawn, (x, y) => to(this.shown(x, y)));
    for (const kind of ["unstable", "stable"]) for (const { points } of marks.manifolds?.[kind] ?? []) manifold(drawn, points.map((it) => to(this.shown(...it))), kind === "stable");
    if (marks.rectangle) rectangle(drawn, marks.rectangle.map(place));
    // The line whose end is moved is drawn where it would be.
    if (marks.line && this.gesture?.grip === undefined) line(drawn, marks.line.map(place));
    if (!this.gesture) return;
    const both = [to(this.gesture.from), to(this.gesture.to)];
    ({ line, rectangle })[this.gesture.kind](drawn, this.gesture.grip === 0 ? both.reverse() : both);
  }

  /** The section point of an attractor or of a saddle under the pointer of an event, if it is so near. */
  met({ clientX, clientY }, near) {
    const box = this.canvas.getBoundingClientRect(), area = this.area(), { attractors, saddles } = this.marks;
    let [best, away] = [null, near];
    for (const [kind, all] of [["attractor", attractors], ["saddle", saddles]]) for (const it of all) {
      const [x, y] = this.place(this.shown(...it.at), area), far = Math.hypot(x - clientX + box.left, y - clientY + box.top);
      if (far <= away) [best, away] = [{ ...it, kind }, far];
    }
    return best;
  }

  // Marks at the edge of the map are not cut off.
  above(drawn, put) {
    const { marks } = this, at = (point, mark) => put(this.shares(point), mark);
    marks.curves?.points(drawn, (x, y, mark) => put(this.shown(x, y), mark));
    marks.attractors.forEach(({ at: place, colour }) => put(this.shown(...place), (drawn, to) => sectionPoint(drawn, to, `rgb(${colour})`)));
    marks.saddles.forEach(({ at: place }) => put(this.shown(...place), saddle));
    this.drawFronts(drawn, at);
    marks.pins.forEach(({ point, name }) => at(point, (drawn, place) => letter(drawn, place, name)));
    if (marks.spot) at(marks.spot, (drawn, place) => dot(drawn, place, colours().mark, 5));
    if (this.chosen) put(this.chosen, cross);
    if (this.hasCursor()) put(this.mark, cursor);
  }

  /** Whether the mark of the keyboard lies elsewhere than the chosen case. */
  hasCursor() { return !!this.mark && !this.mark.every((it, i) => it === this.chosen?.[i]); }

  drawFronts(drawn, at) {
    const all = [];
    for (const [direction, points] of Object.entries(this.marks.fronts)) points.forEach((it) => at(it, (_, place) => all.push([place, front(direction)])));
    dots(drawn, all);
  }

  beside(drawn, area) {
    const { key, told } = this.data, left = area.right + 14;
    if (key.kinds) kinds(drawn, area, left, this.data);
    else bar(drawn, area, left, key);
    if (!key.kinds) upward(drawn, told, sizeOf(this.canvas).width - 10, (area.top + area.bottom) / 2);
  }
}

// The names of the kinds, with the share of the cases that are of each.
function shares({ kinds }, values) {
  const counts = kinds.map(() => 0);
  values.forEach((kind) => { if (kind in counts) counts[kind]++; });
  return kinds.map(([name], i) => `${name}, ${short(100 * counts[i] / values.length, 2)} %`);
}

function keyRoom(canvas, { key, values }) {
  const drawn = canvas.getContext("2d");
  drawn.font = "12px system-ui, sans-serif";
  const texts = key.kinds ? shares(key, values) : numbers(key, 300).map(([, text]) => text);
  const widest = Math.max(30, ...texts.map((it) => drawn.measureText(it).width));
  return Math.min(key.kinds ? widest + 42 : widest + 62, 230);
}

// The kinds with their shares of the cases; what they are of is told above the map.
function kinds(drawn, area, left, { key, values }) {
  const { ink, faint } = colours(), texts = shares(key, values);
  drawn.textBaseline = "middle";
  key.kinds.forEach((_, i) => {
    const rgb = key.kinds[i][1], name = texts[i];
    const top = area.top + 2 + 18 * i, swatch = { left, top, right: left + SWATCH, bottom: top + SWATCH };
    if (rgb) { drawn.fillStyle = `rgb(${rgb})`; drawn.fillRect(left, top, SWATCH, SWATCH); } else hatch(drawn, swatch);
    drawn.strokeStyle = faint;
    drawn.lineWidth = 0.5;
    drawn.strokeRect(left, top, SWATCH, SWATCH);
    drawn.fillStyle = ink;
    drawn.textAlign = "left";
    drawn.fillText(name, left + SWATCH + 6, top + SWATCH / 2, 230 - 40);
  });
}

/** The colours of bars as pictures one pixel wide, from above. */
const bars = new WeakMap();
function picture(key) {
  if (!bars.has(key)) {
    const count = key.colours.length, made = element("canvas", { width: 1, height: count }), image = new ImageData(1, count);
    key.colours.forEach((rgb, i) => image.data.set([...rgb, 255], 4 * (count - 1 - i)));
    made.getContext("2d").putImageData(image, 0, 0);
    bars.set(key, made);
  }
  return bars.get(key);
}

function bar(drawn, area, left, key) {
  const height = area.bottom - area.top, { ink, faint } = colours();
  drawn.drawImage(picture(key), left, area.top, SWATCH, height);
  drawn.strokeStyle = faint;
  drawn.strokeRect(left, area.top, SWATCH, height);
  drawn.fillStyle = ink;
  drawn.textAlign = "left";
  drawn.textBaseline = "middle";
  const at = share(key);
  for (const [value, text] of numbers(key, height)) {
    const y = area.bottom - at(value) * height;
    drawn.beginPath(); drawn.moveTo(left + SWATCH, y); drawn.lineTo(left + SWATCH + 4, y); drawn.stroke();
    drawn.fillText(text, left + SWATCH + 7, y);
  }
}
