// Cases that are drawn at random, as a matrix of scatter plots: outputs over what was drawn.

import * as ask from "./ask.js";
import * as tip from "./tip.js";
import { element, folded, parted, say } from "./element.js";
import { dot } from "./marks.js";
import { colours, context, frame, redrawn, within } from "./plot.js";
import { range, result } from "./ticks.js";

/** Columns and rows at most. */
const MOST = 6;
/** Room for the numbers and titles of the outer plots, and between plots [CSS pixels]. */
const ROOM = { left: 66, bottom: 40, between: 12 };
/** A point is meant that lies so near [CSS pixels]. */
const NEAR = 9;

/** The matrix in its place; `on` is told of a `choose`n case by its coordinates. */
export class Scatter {
  constructor(place, on) {
    Object.assign(this, { on, data: null, spot: null, chosen: null });
    this.canvas = element("canvas", { id: "scatter", tabIndex: 0, role: "application", ariaLabel: "Scatter plots" });
    this.canvas.setAttribute("aria-roledescription", "diagram");
    this.told = element("p", { className: "told", textContent: "\u00a0" });
    this.values = element("div");
    const help = element("p", { className: "note", textContent: "Click a case for its motion: it is marked in all plots. Left and right step through the cases, Enter computes one." });
    place.append(this.canvas, this.told, help, this.values);
    const events = { pointermove: "move", pointerleave: "leave", click: "click", keydown: "key" };
    for (const [name, act] of Object.entries(events)) this.canvas.addEventListener(name, (event) => this[act](event));
    redrawn(this.canvas, () => this.draw());
  }

  /** Shows the draws of the file. */
  async show() {
    const { draws, outputs, cases } = await ask.object("/api/draws");
    const column = (it) => ({ ...it, shown: Float64Array.from(it.values, (value) => (value === null ? NaN : value * it.factor)) });
    this.data = { xs: draws.slice(0, MOST).map(column), ys: outputs.slice(0, MOST).map(column), draws: draws.map(column), count: draws[0].values.length };
    for (const it of [...this.data.xs, ...this.data.ys]) it.range = range(it.shown);
    const { xs, ys, count } = this.data, axis = ({ label }) => parted(label)[0];
    this.canvas.setAttribute("aria-label", `Scatter plots of ${ys.map(axis).join(", ")} over ${xs.map(axis).join(", ")}, ${count} of ${cases} cases`);
    const all = [...xs, ...ys];
    this.values.replaceChildren(folded(`Cases (${count})`, ["case", ...all.map(({ label }) => label)], () => Array.from({ length: count }, (_, i) => [String(i), ...all.map((it) => this.text(it, i))])));
    this.draw();
  }

  text(it, at) { return Number.isNaN(it.shown[at]) ? "–" : result(it.shown[at], it.unit, 4); }

  // The area of the plot in a column and a row.
  area(column, row, { width, height }) {
    const { xs, ys } = this.data, { left, bottom, between } = ROOM;
    const wide = (width - left - 12) / xs.length, high = (height - bottom - 8) / ys.length;
    return { left: left + column * wide, top: 8 + row * high, right: left + (column + 1) * wide - between, bottom: 8 + (row + 1) * high - between };
  }

  // A logarithmic axis needs values above zero.
  axis(it) { return { range: it.range, log: it.log && it.range[0] > 0, label: it.label }; }

  draw() {
    const made = context(this.canvas), { drawn } = made;
    if (!this.data || !made.width) return;
    const { xs, ys, count } = this.data, shades = colours();
    this.places = [];
    ys.forEach((y, row) => xs.forEach((x, column) => {
      const area = this.area(column, row, made), isOuter = [column === 0, row === ys.length - 1];
      const place = frame(drawn, area, { ...this.axis(x), label: isOuter[1] ? x.label : "" }, { ...this.axis(y), label: isOuter[0] ? y.label : "", isBare: !isOuter[0] });
      this.places.push({ area, place, x, y });
      within(drawn, area, () => {
        drawn.fillStyle = shades.first;
        drawn.globalAlpha = count > 2000 ? 0.35 : 0.6;
        for (let i = 0; i < count; i++) {
          if (Number.isNaN(x.shown[i]) || Number.isNaN(y.shown[i])) continue;
          drawn.fillRect(place.x(x.shown[i]) - 1.2, place.y(y.shown[i]) - 1.2, 2.4, 2.4);
        }
        drawn.globalAlpha = 1;
        for (const [at, shade] of [[this.chosen, shades.ink], [this.spot, shades.mark]]) {
          if (at !== null && !Number.isNaN(y.shown[at])) dot(drawn, [place.x(x.shown[at]), place.y(y.shown[at])], shade, 4.5, shades.paper);
        }
      });
    }));
  }

  // The case nearest to the pointer in the plot under it; none where there is none.
  near(event) {
    const box = this.canvas.getBoundingClientRect(), [left, top] = [event.clientX - box.left, event.clientY - box.top];
    const found = this.places?.find(({ area }) => left >= area.left && left <= area.right && top >= area.top && top <= area.bottom);
    if (!found) return null;
    const { place, x, y } = found;
    let [best, away] = [null, NEAR];
    for (let i = 0; i < this.data.count; i++) {
      const far = Math.hypot(place.x(x.shown[i]) - left, place.y(y.shown[i]) - top);
      if (far < away) [best, away] = [i, far];
    }
    return best;
  }

  words(at) { return [...this.data.draws, ...this.data.ys].map((it) => `${parted(it.label)[0]} ${this.text(it, at)}${it.unit && ` ${it.unit}`}`).join("; "); }

  hover(at, event = null) {
    if (at !== null && event) tip.show(event, { head: `case ${at}`, rows: [...this.data.draws, ...this.data.ys].map((it) => tip.pair(it.label, this.text(it, at))) });
    else tip.hide();
    this.told.textContent = at === null ? "\u00a0" : `Case ${at}: ${this.words(at)}`;
    if (at !== null && !event) say(this.told.textContent);
    if (at === this.spot) return;
    this.spot = at;
    this.draw();
  }

  move(event) { if (this.data) this.hover(this.near(event), event); }
  leave() { if (this.data) this.hover(null); }

  click(event) {
    const at = this.data && this.near(event);
    if (at !== null && at !== undefined) this.choose(at);
  }

  choose(at) {
    this.chosen = at;
    this.draw();
    this.on.choose(Object.fromEntries(this.data.draws.map((it) => [it.name, it.values[at]])));
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!this.data || event.ctrlKey || event.metaKey || event.altKey) return;
    if (step) this.hover(Math.min(Math.max((this.spot ?? -1) + step * (event.shiftKey ? 10 : 1), 0), this.data.count - 1));
    else if (event.key === "Enter" && this.spot !== null) this.choose(this.spot);
    else return;
    event.preventDefault();
  }
}
