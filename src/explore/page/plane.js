// A plane of cells that is moved and zoomed, with a mark for the keyboard; lines and rectangles are drawn over it.

import { Cells } from "./cells.js";
import { context, frame, redrawn, room, sizeOf, within } from "./plot.js";
import { along, crosses } from "./snap.js";

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const KINDS = { l: "line", r: "rectangle" };
/** Pixels that a pointer may move in a click. */
const STILL = 4;
/** The least part of an axis that is seen. */
const LEAST = 1e-4;
/** Pixels from the end of a line at which a pointer takes hold of it. */
const GRIP = 11;
/** Significant digits of a point between the cases. */
const DIGITS = 12;

/** A plane on a canvas: `chosen` is the place of the chosen case, `mark` that of the keyboard, in shares. `on` is told of `hover`, `choose`, `looked` (another part is seen), `drag` (a line or a rectangle) and `mode`. */
export class Plane {
  constructor(canvas, on) {
    Object.assign(this, { canvas, on, data: null, window: null, mark: null, chosen: null, mode: "move", gesture: null, isExact: false });
    const events = { pointerdown: "press", pointermove: "move", pointerup: "release", pointercancel: "giveUp", pointerleave: "leave", keydown: "key" };
    for (const [name, act] of Object.entries(events)) canvas.addEventListener(name, (event) => this[act](event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    redrawn(canvas, () => { this.cells?.recolour(); this.draw(); });
  }

  /** Shows these cells. */
  show(data) {
    this.data = data;
    this.cells = new Cells(data);
    this.draw();
  }

  /** The part of the canvas with the cells. */
  area() { return room(sizeOf(this.canvas)); }

  /** What is seen, in shares of the axes. */
  seen() { return this.window || [[0, 1], [0, 1]]; }

  value(axis, share) {
    const [low, high] = axis.range;
    return axis.log ? low * (high / low) ** share : low + share * (high - low);
  }

  share(axis, value) {
    const [low, high] = axis.range;
    if (low === high) return 0.5;
    return axis.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  }

  /** The shares of both axes at a place in SI. */
  shares([x, y]) {
    return [this.share(this.data.x, x * this.data.x.factor), this.share(this.data.y, y * this.data.y.factor)];
  }

  /** The cell at shares of the axes, the value of its case, and the very point, both in SI. */
  at([x, y]) {
    const { data } = this;
    const cell = ({ ends }, share) => {
      let [low, high] = [0, ends.length - 1];
      while (low < high) { const middle = (low + high) >> 1; if (ends[middle] < share) low = middle + 1; else high = middle; }
      return low;
    };
    const [column, row] = [cell(data.x, x), cell(data.y, y)];
    const si = (axis, share) => Number((this.value(axis, share) / axis.factor).toPrecision(DIGITS));
    return {
      column, row, number: row * data.x.values.length + column,
      cell: [data.x.values[column], data.y.values[row]], point: [si(data.x, x), si(data.y, y)],
    };
  }

  /** The shares of the case of the cell, or those given where points between the cases are taken. */
  snapped(shares) { return this.isExact ? shares : this.shares(this.at(shares).cell); }

  /** The place on the canvas of shares of the axes. */
  place([x, y], area = this.area()) {
    const [across, up] = this.seen();
    return [
      area.left + (x - across[0]) / (across[1] - across[0]) * (area.right - area.left),
      area.bottom - (y - up[0]) / (up[1] - up[0]) * (area.bottom - area.top),
    ];
  }

  // The shares under the pointer; none beyond the frame, unless they are to be clamped to it.
  pointed(event, isClamped = false) {
    const box = this.canvas.getBoundingClientRect(), area = this.area(), [across, up] = this.seen();
    let x = (event.clientX - box.left - area.left) / (area.right - area.left);
    let y = (area.bottom - event.clientY + box.top) / (area.bottom - area.top);
    if (isClamped) [x, y] = [x, y].map((it) => Math.min(Math.max(it, 0), 1));
    else if (x < 0 || x > 1 || y < 0 || y > 1) return null;
    return [across[0] + x * (across[1] - across[0]), up[0] + y * (up[1] - up[0])];
  }

  press(event) {
    const shares = this.data && event.button === 0 && this.pointed(event);
    if (!shares) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.held = { from: [event.clientX, event.clientY], seen: this.seen(), shares, hasMoved: false };
    const from = this.mode === "line" ? this.snapped(shares) : shares, grip = this.grip(event);
    if (this.mode !== "move") this.gesture = { kind: this.mode, from, to: from };
    else if (grip !== null) this.gesture = { kind: "line", from: this.ends()[1 - grip], to: this.ends()[grip], grip };
  }

  /** The ends of a line over the plane, in shares, which a pointer can take hold of. */
  ends() { return []; }

  // The end of the line under the pointer; none elsewhere.
  grip(event) {
    if (!this.on.drag || this.mode !== "move") return null;
    const box = this.canvas.getBoundingClientRect(), area = this.area();
    const away = this.ends().map((it) => this.place(it, area)).map(([x, y]) => Math.hypot(x - event.clientX + box.left, y - event.clientY + box.top));
    const nearest = away.indexOf(Math.min(...away));
    return away[nearest] <= GRIP ? nearest : null;
  }

  move(event) {
    if (!this.data) return;
    if (!this.held) {
      this.canvas.style.cursor = this.grip(event) === null ? "" : "move";
      return this.hovered(this.pointed(event), event);
    }
    const [dx, dy] = [event.clientX - this.held.from[0], event.clientY - this.held.from[1]];
    if (Math.hypot(dx, dy) > STILL) this.held.hasMoved = true;
    if (this.gesture) {
      this.extend(this.pointed(event, true), event.shiftKey);
      this.hovered(this.gesture.to, event);
    }
    else if (this.held.hasMoved && this.window) {
      const area = this.area(), [x, y] = this.held.seen;
      const [right, up] = [dx / (area.right - area.left) * (x[1] - x[0]), -dy / (area.bottom - area.top) * (y[1] - y[0])];
      this.look([x[0] - right, x[1] - right], [y[0] - up, y[1] - up]);
    }
  }

  release(event) {
    const { held } = this;
    this.held = null;
    if (!held) return;
    // An end of a line that was not moved is a case like others.
    if (this.gesture?.grip !== undefined && !held.hasMoved) this.gesture = null;
    if (this.gesture) { if (held.hasMoved) this.finish(); else this.giveUp(); }
    else if (!held.hasMoved) this.choose(held.shares, this.isExact || event.altKey);
  }

  leave() { if (!this.held) this.hovered(null); }

  hovered(shares, event = null) { this.on.hover?.(shares && this.at(shares), false, event); }

  // The other end of the line or the rectangle that is drawn.
  extend(to, isStraight) {
    const { gesture } = this;
    gesture.to = gesture.kind === "line" ? this.snapped(along(gesture.from, to, (it) => this.place(it), isStraight)) : to;
    this.draw();
  }

  finish() {
    const { kind, from, to, byKeys, grip } = this.gesture, isCell = kind === "line" && !this.isExact;
    // The end that was not moved is as it was.
    const held = grip === undefined ? null : this.fixed(1 - grip), end = (it) => this.at(it)[isCell ? "cell" : "point"];
    const [begins, ends] = grip === 0 ? [end(to), held] : [held ?? end(from), end(to)];
    this.gesture = null;
    if (byKeys && kind === "line") this.mark = to;
    this.setMode("move");
    this.canvas.style.cursor = "";
    this.on.drag(kind, begins, ends);
  }

  giveUp() {
    Object.assign(this, { gesture: null, held: null });
    this.setMode("move");
  }

  /** What dragging does: "move", "line" or "rectangle". */
  setMode(mode) {
    this.mode = mode;
    this.gesture = null;
    this.on.mode?.(mode);
    this.draw();
  }

  /** The places of what is chosen: those of the case of the cell, or the very point. */
  choose(shares, isExact) {
    const at = this.at(shares);
    this.mark = this.chosen = isExact ? shares : this.shares(at.cell);
    this.draw();
    this.on.choose(isExact ? at.point : at.cell, at);
  }

  wheel(event) {
    const shares = this.data && this.pointed(event);
    // At the whole plane the page scrolls.
    if (!shares || (event.deltaY > 0 && !this.window)) return;
    event.preventDefault();
    this.zoom(event.deltaY > 0 ? 1.25 : 0.8, shares);
  }

  /** Zooms about shares of the axes: the mark where it is seen, else the middle. */
  zoom(factor, about = this.centre()) {
    const part = (at, [low, high]) => [at + (low - at) * factor, at + (high - at) * factor];
    const [x, y] = this.seen();
    this.look(part(about[0], x), part(about[1], y));
  }

  /** Whether a place, or a part of a line between two places, is seen. */
  isSeen(place) { return crosses(place, place, this.seen()); }
  crosses(from, to) { return crosses(from, to, this.seen()); }

  centre() {
    const [x, y] = this.seen();
    return this.mark && this.isSeen(this.mark) ? this.mark : [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
  }

  /** Sees this part, moved and shortened so that it lies within; the whole without one. */
  look(x = [0, 1], y = [0, 1]) {
    const inside = ([low, high]) => {
      const length = Math.min(Math.max(high - low, LEAST), 1), begins = Math.min(Math.max(low, 0), 1 - length);
      return [begins, begins + length];
    };
    const window = [inside(x), inside(y)];
    this.window = window.every(([low, high]) => high - low === 1) ? null : window;
    this.on.looked?.(this.window);
    this.draw();
  }

  key(event) {
    if (!this.data || event.ctrlKey || event.metaKey || event.altKey) return;
    const mark = this.centre(), letter = event.key.toLowerCase(), isEnter = event.key === "Enter" || event.key === " ";
    // A mark that is not seen is placed before anything is computed there.
    if ((ARROWS[event.key] || isEnter) && mark !== this.mark) this.put(this.snapped(mark));
    else if (ARROWS[event.key]) this.step(mark, ARROWS[event.key], event.shiftKey);
    else if (isEnter) { if (this.gesture) this.finish(); else this.choose(mark, this.isExact); }
    else if (event.key === "+" || event.key === "=") this.zoom(0.8);
    else if (event.key === "-") this.zoom(1.25);
    else if (event.key === "0") this.look();
    else if (event.key === "Escape" && this.mode !== "move") this.giveUp();
    else if (KINDS[letter] && this.on.drag) this.begin(KINDS[letter], this.snapped(mark));
    else return;
    event.preventDefault();
  }

  begin(kind, mark) {
    if (this.gesture) return this.finish();
    this.setMode(kind);
    this.mark = mark;
    this.gesture = { kind, from: mark, to: mark, byKeys: true };
    this.draw();
  }

  // Places the mark of the keyboard.
  put(mark) {
    this.mark = mark;
    if (this.gesture) this.extend(mark, false); else this.draw();
    this.on.hover?.(this.at(mark), true);
  }

  // The mark goes from case to case, or by hundredths of what is seen.
  step(mark, [right, up], isFar) {
    const far = isFar ? 10 : 1, { column, row } = this.at(mark), [x, y] = this.seen();
    const near = (axis, place) => this.share(axis, axis.values[Math.min(Math.max(place, 0), axis.values.length - 1)] * axis.factor);
    const by = (share, [low, high], step) => Math.min(Math.max(share + 0.01 * far * step * (high - low), 0), 1);
    if (this.isExact) this.mark = [by(mark[0], x, right), by(mark[1], y, up)];
    else this.mark = [near(this.data.x, column + far * right), near(this.data.y, row + far * up)];
    this.follow();
    this.put(this.mark);
  }

  // What is seen moves with the mark.
  follow() {
    const moved = ([low, high], it) => (it < low ? [it, it + high - low] : it > high ? [it - high + low, it] : [low, high]);
    const [x, y] = this.seen();
    if (this.window) this.look(moved(x, this.mark[0]), moved(y, this.mark[1]));
  }

  draw() {
    const { drawn, ratio, width } = context(this.canvas);
    if (!this.data || !width) return;
    const area = this.area(), [across, up] = this.seen(), { x, y } = this.data;
    within(drawn, area, () => {
      this.cells.paint(drawn, area, [across, up], ratio);
      this.over?.(drawn, (shares) => this.place(shares, area));
    });
    const axis = (it, [low, high]) => ({ label: it.label, log: it.log, range: [this.value(it, low), this.value(it, high)] });
    frame(drawn, area, axis(x, across), axis(y, up));
    this.above(drawn, (shares, mark) => this.isSeen(shares) && mark(drawn, this.place(shares, area)));
    this.beside?.(drawn, area);
  }
}
