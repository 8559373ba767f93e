// The trade-off beside the map: speed against what it costs, with the fronts, brushed both ways.

import * as ask from "./ask.js";
import * as tip from "./tip.js";
import { Cloud } from "./cloud.js";
import { button, element, folded, labelled, parted, say, said, select } from "./element.js";
import { isReversed } from "./form.js";
import { saveButtons } from "./keep.js";
import { cross, dot, dots, entry, front, rectangle } from "./marks.js";
import { colours, context, frame, redrawn, room, within } from "./plot.js";
import { range, result, short } from "./ticks.js";

/** Ratio of prices above which their logarithm is shown. */
const MANY = 1000;
const STILL = 4;

/** The outputs of a file that can be a price: their names and labels. */
export function prices(file) {
  return file.model.costs.map(({ name, label }) => [name, label]);
}

/** The trade-off in its place. `on` is told of the `price`, a `choose`n cell, the cell under the pointer and a `brush`ed rectangle. */
export class TradeOff {
  constructor(place, options, on) {
    Object.assign(this, { on, data: null, mask: null, brush: null, spot: null, chosen: null, drag: null });
    this.canvas = element("canvas", { id: "trade-off", tabIndex: 0, role: "application", ariaLabel: "Trade-off" });
    this.canvas.setAttribute("aria-roledescription", "diagram");
    this.canvas.setAttribute("aria-describedby", "trade-off-help trade-off-told");
    this.told = element("p", { id: "trade-off-told", className: "told", textContent: "\u00a0" });
    this.note = element("p", { id: "trade-off-note", className: "note" });
    this.legend = element("ul", { className: "legend", ariaLabel: "Marks of the trade-off" });
    this.price = select("price", options, options[0]?.[0], (name) => on.price(name));
    this.brushed = element("p", { id: "brush-told" });
    this.clear = button("Clear the selection", () => on.brush(null), { id: "brush-clear", hidden: true });
    this.fronts = element("div", { id: "trade-off-fronts" });
    const help = element("p", { id: "trade-off-help", className: "note" });
    help.textContent = "Drag a rectangle to mark its cases in the map; click a point for its motion. Left and right step along the fronts, Enter computes there.";
    this.saving = element("div", { className: "buttons" }, saveButtons("trade-off", "trade-off", () => this.request));
    const drop = button("Take off the map", () => on.drop(), { id: "trade-off-drop" });
    place.append(element("div", { className: "buttons" }, labelled("Price", this.price), this.clear, drop), this.canvas, this.told, this.legend, this.note, this.brushed, help, this.numbers(), this.fronts, this.saving);
    this.listen();
  }

  listen() {
    const events = { pointerdown: "press", pointermove: "move", pointerup: "release", pointercancel: "giveUp", pointerleave: "leave", keydown: "key" };
    for (const [name, act] of Object.entries(events)) this.canvas.addEventListener(name, (event) => this[act](event));
    redrawn(this.canvas, () => {
      this.cloud = null;
      if (this.data) this.explain();
      this.draw();
    });
  }

  // The rectangle by numbers.
  numbers() {
    this.inputs = ["Price from", "Price to", "Speed from", "Speed to"].map((name) => element("input", { type: "number", step: "any", required: true, ariaLabel: name }));
    const form = element("form", { className: "row" });
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const pairs = [this.inputs.slice(0, 2), this.inputs.slice(2)], names = [this.data.price.label, this.data.speed.label];
      if (pairs.some((ends, i) => isReversed(...ends, names[i]))) return;
      this.on.brush(pairs.map((ends) => ends.map((it) => Number(it.value))));
    });
    this.form = form;
    return element("details", {}, element("summary", { textContent: "Select by numbers, in the units of the axes" }), form);
  }

  // The fields are called as the axes are.
  nameFields() {
    const { price, speed } = this.data, words = [`${price.label} from`, "to", `${speed.label} from`, "to"];
    const key = words.join();
    if (this.form.dataset.key === key) return;
    this.form.dataset.key = key;
    this.form.replaceChildren(...this.inputs.map((it, i) => labelled(words[i], it)), element("button", { textContent: "Select" }));
  }

  /** Shows the trade-off of the cells of a map; `request` is that of its figure, too; `plane` has what the plane holds in words, and
   * how many `cases` the file has. */
  async show(request, map, plane, signal) {
    const data = await ask.tradeOff(request, signal);
    Object.assign(this, { data, map, plane, request: { kind: "trade-off", ...request }, spot: null, mask: null, cloud: null });
    this.price.value = data.price.name;
    this.saving.hidden = false;
    this.list = ["forward", "backward"].flatMap((direction) => (data.fronts[direction] || []).map((cell) => ({ direction, cell })));
    this.measure();
    this.tell();
    this.draw();
  }

  /** Shows no trade-off, and why. */
  none(why) {
    Object.assign(this, { data: null, cloud: null, mask: null, spot: null });
    this.note.textContent = why;
    [this.legend, this.fronts].forEach((it) => it.replaceChildren());
    this.saving.hidden = true;
    this.select(null, null, "");
  }

  measure() {
    const { prices, speeds, price, speed } = this.data;
    let [low, high, count] = [Infinity, -Infinity, 0];
    for (const it of prices) if (Number.isFinite(it)) { low = Math.min(low, it); high = Math.max(high, it); count++; }
    const log = low > 0 && high / low > MANY;
    this.x = { label: price.label, log, range: log ? [low / 1.2, high * 1.2] : range(count ? [low, high] : [], 0.04) };
    this.y = { label: speed.label, range: range(speeds, 0.06) };
    this.count = count;
  }

  tell() {
    const { left_out: out, price, speed } = this.data;
    const whole = this.data.prices.length, without = (out || []).filter((it) => it[1]).map(([why, number]) => `${number} ${why}`);
    const { held, cases } = this.plane, part = whole < cases ? ` of this plane${held ? ` (${held})` : ""}` : "";
    const points = `${this.count} of ${whole} cases${part} are shown${part ? `; the file has ${cases}` : ""}`;
    this.note.textContent = `${points}${without.length ? `; left out: ${without.join(", ")}` : ""}${this.x.log ? "; the price is on a logarithmic axis" : ""}.`;
    this.canvas.setAttribute("aria-label", `Trade-off: ${speed.label} over ${price.label}, ${points}, ${this.list.length} on the fronts`);
    this.fronts.replaceChildren(...["forward", "backward"].filter((it) => this.data.fronts[it]?.length).flatMap((it) => [this.fastest(it), this.table(it)]));
    this.nameFields();
    this.explain();
  }

  fastest(direction) {
    const { fronts, speeds } = this.data;
    const best = fronts[direction].reduce((one, cell) => (Math.abs(speeds[cell]) > Math.abs(speeds[one]) ? cell : one));
    return element("p", { textContent: `Fastest ${direction}: ${this.words(best)}` });
  }

  table(direction) {
    const cells = this.data.fronts[direction], { price, speed } = this.data, { x, y } = this.map.data;
    const rows = () => cells.map((cell) => {
      const [a, b] = this.coordinates(cell), place = `${said(x.label, a * x.factor)}, ${said(y.label, b * y.factor)}`;
      const show = button("Show", () => this.on.choose(cell), { ariaLabel: `Show the motion at ${place}` });
      return [result(this.data.prices[cell], parted(price.label)[1]), result(this.data.speeds[cell], parted(speed.label)[1]), short(a * x.factor), short(b * y.factor), show];
    });
    return folded(`Front, ${direction} (${cells.length} cases, by rising price)`, [price.label, speed.label, x.label, y.label, "motion"], rows);
  }

  explain() {
    const shades = colours();
    const point = (shade) => (drawn, at) => dot(drawn, at, shade, 3);
    const entries = [entry(this.mask ? "case, not selected" : "case", point(this.mask ? shades.faint : shades.third))];
    if (this.mask) entries.push(entry("selected case", point(shades.third)));
    for (const direction of ["forward", "backward"]) {
      if (!this.data.fronts[direction]?.length) continue;
      entries.push(entry(`front, ${direction}, also on the map`, (drawn, [x, y]) => {
        [drawn.strokeStyle, drawn.lineWidth] = [front(direction), 2];
        drawn.beginPath(); drawn.moveTo(x - 12, y); drawn.lineTo(x + 12, y); drawn.stroke();
        dot(drawn, [x, y], front(direction));
      }));
    }
    if (this.chosen !== null) entries.push(entry("chosen case", (drawn, at) => cross(drawn, at)));
    this.legend.replaceChildren(...entries);
  }

  /** The coordinates of a cell of the map in SI. */
  coordinates(cell) {
    const { x, y } = this.map.data, columns = x.values.length;
    return [x.values[cell % columns], y.values[Math.floor(cell / columns)]];
  }

  /** Marks the cells of a mask; `brush` is the rectangle of this plane that did, if it was one. */
  select(mask, brush, words) {
    Object.assign(this, { mask, brush, cloud: null });
    this.brushed.textContent = words;
    this.clear.hidden = !mask;
    if (!this.data) return this.draw();
    if (brush) this.inputs.forEach((input, i) => { input.value = String(Number(brush[i >> 1][i & 1].toPrecision(6))); });
    this.explain();
    this.draw();
  }

  /** The mask of the cases in a rectangle of this plane. */
  within([[p0, p1], [s0, s1]]) {
    const { prices, speeds } = this.data;
    return Uint8Array.from(prices, (price, i) => (price >= p0 && price <= p1 && speeds[i] >= s0 && speeds[i] <= s1 ? 1 : 0));
  }

  /** Marks the chosen cell, and the one under the pointer on the map. */
  mark(chosen, spot = null) {
    Object.assign(this, { chosen, spot });
    if (!this.data) return;
    this.explain();
    this.draw();
  }

  pointed(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  // The values at a place of the canvas, within the axes.
  values([x, y]) {
    const area = room(this.canvas.getBoundingClientRect()), clamped = (it) => Math.min(Math.max(it, 0), 1);
    const [across, up] = [clamped((x - area.left) / (area.right - area.left)), clamped((area.bottom - y) / (area.bottom - area.top))];
    const value = ({ range: [low, high], log }, share) => (log ? low * (high / low) ** share : low + share * (high - low));
    return [value(this.x, across), value(this.y, up)];
  }

  press(event) {
    if (!this.data || event.button !== 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.drag = { from: this.pointed(event), to: this.pointed(event) };
  }

  move(event) {
    if (!this.data) return;
    const at = this.pointed(event);
    if (this.drag) { this.drag.to = at; this.draw(); } else this.hover(this.cloud?.near(...at) ?? null, false, event);
  }

  release() {
    const { drag } = this;
    this.drag = null;
    if (!drag) return;
    if (Math.hypot(drag.to[0] - drag.from[0], drag.to[1] - drag.from[1]) <= STILL) {
      const cell = this.cloud.near(...drag.from);
      if (cell !== null) this.on.choose(cell);
      return;
    }
    const [a, b] = [this.values(drag.from), this.values(drag.to)];
    this.on.brush([0, 1].map((i) => [Math.min(a[i], b[i]), Math.max(a[i], b[i])]));
  }

  giveUp() { this.drag = null; this.draw(); }

  leave() { if (this.data && !this.drag) this.hover(null, false); }

  hover(cell, isKey, event = null) {
    if (cell !== null && event) this.beside(cell, event); else tip.hide();
    const words = cell === null ? "\u00a0" : this.words(cell);
    this.told.textContent = words;
    if (isKey && cell !== null) say(words);
    if (cell === this.spot) return;
    this.spot = cell;
    this.on.spot(cell);
    this.draw();
  }

  // Values beside the pointer.
  beside(cell, event) {
    const { price, speed, prices, speeds } = this.data, { x, y } = this.map.data, at = this.coordinates(cell);
    const output = ({ label }, value) => tip.pair(label, result(value, parted(label)[1]));
    const places = [x, y].map((it, i) => tip.pair(it.label, short(at[i] * it.factor)));
    tip.show(event, { head: output(speed, speeds[cell])[1], rows: [output(price, prices[cell]), ...places] });
  }

  words(cell) {
    const { price, speed, prices, speeds } = this.data, { x, y } = this.map.data, [a, b] = this.coordinates(cell);
    const output = ({ label }, value) => said(label, result(value, parted(label)[1]));
    return [output(price, prices[cell]), output(speed, speeds[cell]), said(x.label, a * x.factor), said(y.label, b * y.factor)].join("; ");
  }

  key(event) {
    if (!this.data || event.ctrlKey || event.metaKey || event.altKey) return;
    const { list } = this, now = list.findIndex((it) => it.cell === this.spot);
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (step && list.length) this.hover(list[Math.min(Math.max(now + step, 0), list.length - 1)].cell, true);
    else if (event.key === "Enter" && this.spot !== null) this.on.choose(this.spot);
    else if (event.key === "Escape" && this.mask) this.on.brush(null);
    else return;
    event.preventDefault();
  }

  draw() {
    const made = context(this.canvas), { drawn, ratio } = made;
    if (!this.data || !made.width) return;
    const area = room(made), { prices, speeds } = this.data, shades = colours();
    const place = frame(drawn, area, this.x, this.y);
    within(drawn, area, () => {
      this.drawZero(drawn, area, place, shades);
      if (!this.cloud?.fits(area, ratio)) this.cloud = this.points(area, ratio, place);
      this.cloud.draw(drawn);
      dots(drawn, ["forward", "backward"].flatMap((direction) => this.drawFront(drawn, place, direction)), shades.paper);
      const at = (cell) => [place.x(prices[cell]), place.y(speeds[cell])];
      const corners = this.brush?.[0].map((it, i) => [place.x(it), place.y(this.brush[1][i])]);
      if (corners) rectangle(drawn, corners);
      if (this.drag) rectangle(drawn, [this.drag.from, this.drag.to]);
      if (this.spot !== null && Number.isFinite(prices[this.spot])) dot(drawn, at(this.spot), shades.mark, 5);
      if (this.chosen !== null && Number.isFinite(prices[this.chosen])) cross(drawn, at(this.chosen));
    });
  }

  // The points of the cases, those that are selected over the others.
  points(area, ratio, place) {
    const { mask } = this, cloud = new Cloud(area, ratio, place, this.data.prices, this.data.speeds), shades = colours();
    if (mask) cloud.add((cell) => !mask[cell], shades.faint);
    cloud.add((cell) => !mask || mask[cell], shades.third);
    return cloud;
  }

  drawZero(drawn, area, place, shades) {
    if (this.y.range[0] >= 0 || this.y.range[1] <= 0) return;
    [drawn.strokeStyle, drawn.lineWidth] = [shades.line, 1];
    drawn.beginPath(); drawn.moveTo(area.left, place.y(0)); drawn.lineTo(area.right, place.y(0)); drawn.stroke();
  }

  // Stairs: up to the next case, the last one stays the best. Returns its dots.
  drawFront(drawn, place, direction) {
    const { prices, speeds, fronts } = this.data, cells = fronts[direction] || [];
    [drawn.strokeStyle, drawn.lineWidth] = [front(direction), 2];
    drawn.beginPath();
    cells.forEach((cell, i) => {
      if (i) drawn.lineTo(place.x(prices[cell]), place.y(speeds[cells[i - 1]]));
      drawn.lineTo(place.x(prices[cell]), place.y(speeds[cell]));
    });
    drawn.stroke();
    return cells.map((cell) => [[place.x(prices[cell]), place.y(speeds[cell])], front(direction)]);
  }
}
