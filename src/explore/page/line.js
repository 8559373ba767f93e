// The bifurcation diagram along a line over the map, drawn as it is computed.

import * as ask from "./ask.js";
import { colour, context, frame, range } from "./plot.js";

/** The diagram on a canvas. */
export class Line {
  constructor(canvas, told) {
    Object.assign(this, { canvas, told, points: [], label: "", running: null });
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Computes along the line from one place to another, each by the names of the coordinates in SI; `axis` is the one to show. */
  async follow(from, to, others, axis, start) {
    this.running?.abort();
    const running = new AbortController();
    this.running = running;
    Object.assign(this, { points: [], axis, ends: [from[axis.name] * axis.factor, to[axis.name] * axis.factor] });
    const count = 300;
    const ends = Object.fromEntries(Object.entries(to).map(([name, value]) => [`to_${name}`, value]));
    const began = performance.now();
    let isWaiting = false;
    const draw = () => { isWaiting = false; this.draw(); };
    try {
      await ask.lines("/api/line", { ...others, ...from, ...ends, count, start }, (point) => {
        this.points.push(point);
        const left = (performance.now() - began) / this.points.length * (count - this.points.length) / 1e3;
        this.told.textContent = `${this.points.length} of ${count} values, ${left.toFixed(0)} s left`;
        if (!isWaiting) { isWaiting = true; requestAnimationFrame(draw); }
      }, running.signal);
      this.told.textContent = `${this.points.length} values in ${((performance.now() - began) / 1e3).toFixed(1)} s`;
    } catch (fault) {
      if (fault.name !== "AbortError") this.told.textContent = fault.message;
    }
  }

  draw() {
    const { drawn, width, height } = context(this.canvas);
    if (!this.axis) return;
    const at = (share) => this.ends[0] + share * (this.ends[1] - this.ends[0]);
    const middle = (height - 40) * 0.62;
    const [low, high] = [...this.ends].sort((a, b) => a - b);
    const x = { range: low === high ? [low - 1, high + 1] : [low, high], label: this.axis.label };
    const sections = this.points.flatMap((it) => it.section_r.map((r) => r * 1e3));
    const speeds = this.points.map((it) => it.progression_speed === null ? NaN : it.progression_speed * 1e3);
    const upper = frame(drawn, { left: 66, top: 8, right: width - 10, bottom: middle - 12 }, { ...x, label: "" }, { range: range(sections), label: "x1 − x2 (mm)" });
    const lower = frame(drawn, { left: 66, top: middle + 14, right: width - 10, bottom: height - 40 }, x, { range: range(speeds), label: "Speed (mm/s)" });
    for (const [i, point] of this.points.entries()) {
      drawn.fillStyle = colour(point.outcome === "periodic" ? "first" : "second");
      for (const r of point.section_r) drawn.fillRect(upper.x(at(point.share)) - 0.8, upper.y(r * 1e3) - 0.8, 1.6, 1.6);
      if (Number.isFinite(speeds[i])) drawn.fillRect(lower.x(at(point.share)) - 1, lower.y(speeds[i]) - 1, 2, 2);
    }
  }
}
