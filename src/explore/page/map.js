// The map: its cells as a texture that is moved and zoomed, the mark, and what lies under the pointer.

import { colour, context, frame, short, ticks } from "./plot.js";

const KEY = 110;

/** A map on a canvas. `on` has what is called with places in SI: `hover`, `choose` and `line`. */
export class Map {
  constructor(canvas, on) {
    Object.assign(this, { canvas, on, data: null, window: null, mark: null, pinned: [], line: null, isDrawingLine: false });
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Shows other cells; what is seen of the axes stays if they are the same. */
  show(data) {
    const isSame = this.data && this.data.x.name === data.x.name && this.data.y.name === data.y.name;
    this.data = data;
    const [columns, rows] = [data.x.values.length, data.y.values.length];
    this.texture = document.createElement("canvas");
    [this.texture.width, this.texture.height] = [columns, rows];
    this.texture.getContext("2d").putImageData(new ImageData(data.colours, columns, rows), 0, 0);
    if (!isSame) { this.window = null; this.line = null; this.mark = null; }
    this.draw();
  }

  /** Shows the whole map. */
  whole() { this.window = null; this.draw(); }

  area() {
    const { width, height } = this.canvas.getBoundingClientRect();
    return { left: 66, top: 8, right: Math.max(width - KEY, 120), bottom: Math.max(height - 40, 60) };
  }

  // The window is what is seen of the map, in shares of its axes.
  seen() { return this.window || { x: [0, 1], y: [0, 1] }; }

  value(axis, share) {
    const [low, high] = axis.range;
    return axis.log ? low * (high / low) ** share : low + share * (high - low);
  }

  share(axis, value) {
    const [low, high] = axis.range;
    return axis.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  }

  // Shares of both axes at a point of the canvas.
  shares(event) {
    const box = this.canvas.getBoundingClientRect(), area = this.area(), seen = this.seen();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const across = (x - area.left) / (area.right - area.left), up = (area.bottom - y) / (area.bottom - area.top);
    if (across < 0 || across > 1 || up < 0 || up > 1) return null;
    return [seen.x[0] + across * (seen.x[1] - seen.x[0]), seen.y[0] + up * (seen.y[1] - seen.y[0])];
  }

  // The cell at shares of the axes, and the place there in SI.
  at([x, y]) {
    const { data } = this;
    const cell = (axis, share) => {
      let [low, high] = [0, axis.ends.length - 1];
      while (low < high) { const middle = (low + high) >> 1; if (axis.ends[middle] < share) low = middle + 1; else high = middle; }
      return low;
    };
    const [column, row] = [cell(data.x, x), cell(data.y, y)];
    const si = (axis, share) => this.value(axis, share) / axis.factor;
    return {
      column, row, value: data.values[row * data.x.values.length + column],
      cell: [data.x.values[column], data.y.values[row]], point: [si(data.x, x), si(data.y, y)],
    };
  }

  press(event) {
    const shares = this.data && this.shares(event);
    if (!shares) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.held = { from: [event.clientX, event.clientY], seen: structuredClone(this.seen()), shares, moved: false };
    if (this.isDrawingLine) this.line = { from: shares, to: shares };
  }

  move(event) {
    if (!this.data) return;
    const shares = this.shares(event);
    if (!this.held) { this.on.hover(shares && this.at(shares)); return; }
    const [dx, dy] = [event.clientX - this.held.from[0], event.clientY - this.held.from[1]];
    if (Math.hypot(dx, dy) > 4) this.held.moved = true;
    if (this.isDrawingLine) { if (shares) { this.line.to = shares; this.draw(); } return; }
    if (this.held.moved && this.window) {
      const area = this.area(), { x, y } = this.held.seen;
      const [right, up] = [dx / (area.right - area.left) * (x[1] - x[0]), -dy / (area.bottom - area.top) * (y[1] - y[0])];
      this.look([x[0] - right, x[1] - right], [y[0] - up, y[1] - up]);
    }
  }

  release(event) {
    const { held } = this;
    this.held = null;
    if (!held) return;
    if (this.isDrawingLine) {
      if (held.moved) this.on.line(this.at(this.line.from), this.at(this.line.to));
      return;
    }
    if (!held.moved) this.choose(held.shares, event.altKey);
  }

  // A click takes the case of the cell; with Alt the very point.
  choose(shares, isExact) {
    const at = this.at(shares);
    this.mark = isExact ? shares : [this.share(this.data.x, at.cell[0] * this.data.x.factor), this.share(this.data.y, at.cell[1] * this.data.y.factor)];
    this.draw();
    this.on.choose(isExact ? at.point : at.cell, at);
  }

  /** Puts the mark at a place in SI. */
  point([x, y]) {
    this.mark = [this.share(this.data.x, x * this.data.x.factor), this.share(this.data.y, y * this.data.y.factor)];
    this.draw();
  }

  wheel(event) {
    const shares = this.data && this.shares(event);
    if (!shares) return;
    event.preventDefault();
    this.zoom(shares, event.deltaY > 0 ? 1.25 : 0.8);
  }

  zoom([x, y], factor) {
    const seen = this.seen();
    const about = (at, [low, high]) => [at + (low - at) * factor, at + (high - at) * factor];
    this.look(about(x, seen.x), about(y, seen.y));
  }

  // Sees this part of the map, moved and shortened so that it lies within.
  look(x, y) {
    const within = ([low, high]) => {
      const length = Math.min(Math.max(high - low, 1e-4), 1);
      const begins = Math.min(Math.max(low, 0), 1 - length);
      return [begins, begins + length];
    };
    this.window = { x: within(x), y: within(y) };
    if (this.window.x[1] - this.window.x[0] === 1 && this.window.y[1] - this.window.y[0] === 1) this.window = null;
    this.draw();
  }

  key(event) {
    if (!this.data || event.ctrlKey || event.metaKey) return;
    const centre = () => { const { x, y } = this.seen(); return [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2]; };
    const mark = this.mark || centre();
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (steps[event.key]) {
      const { column, row } = this.at(mark), { x, y } = this.data;
      const near = (axis, place) => this.share(axis, axis.values[Math.min(Math.max(place, 0), axis.values.length - 1)] * axis.factor);
      const far = event.shiftKey ? 10 : 1;
      this.mark = [near(x, column + far * steps[event.key][0]), near(y, row + far * steps[event.key][1])];
      if (this.line && this.isDrawingLine) this.line.to = this.mark;
      this.draw();
      this.on.hover(this.at(this.mark));
    } else if (event.key === "Enter" || event.key === " ") this.choose(mark, false);
    else if (event.key === "+") this.zoom(mark, 0.8);
    else if (event.key === "-") this.zoom(mark, 1.25);
    else if (event.key === "0") this.whole();
    else if (event.key === "l" || event.key === "L") {
      if (this.line && this.isDrawingLine) { this.on.line(this.at(this.line.from), this.at(mark)); this.on.mode(false); }
      else { this.on.mode(true); this.line = { from: mark, to: mark }; }
      this.draw();
    } else return;
    event.preventDefault();
  }

  draw() {
    const { drawn } = context(this.canvas);
    if (!this.data) return;
    const area = this.area(), seen = this.seen(), { x, y } = this.data;
    drawn.save();
    drawn.beginPath();
    drawn.rect(area.left, area.top, area.right - area.left, area.bottom - area.top);
    drawn.clip();
    drawn.imageSmoothingEnabled = false;
    this.drawCells(drawn, area, seen);
    const to = ([sx, sy]) => [
      area.left + (sx - seen.x[0]) / (seen.x[1] - seen.x[0]) * (area.right - area.left),
      area.bottom - (sy - seen.y[0]) / (seen.y[1] - seen.y[0]) * (area.bottom - area.top),
    ];
    if (this.line) this.stroke(drawn, [to(this.line.from), to(this.line.to)]);
    for (const pin of this.pinned) this.cross(drawn, to(pin), colour("fourth"));
    if (this.mark) this.cross(drawn, to(this.mark), colour("mark"));
    drawn.restore();
    const axis = (it, [low, high]) => ({ label: it.label, log: it.log, range: [this.value(it, low), this.value(it, high)] });
    frame(drawn, area, axis(x, seen.x), axis(y, seen.y));
    this.drawKey(drawn, area);
  }

  // The texture has a pixel for each cell; uneven axes have cells of their own widths.
  drawCells(drawn, area, seen) {
    const { x, y } = this.data, [columns, rows] = [x.values.length, y.values.length];
    const isEven = (ends) => ends.every((end, i) => Math.abs(end - this.evenEnd(i, ends.length)) < 1e-3 / ends.length);
    const across = (share) => area.left + (share - seen.x[0]) / (seen.x[1] - seen.x[0]) * (area.right - area.left);
    const down = (share) => area.bottom - (share - seen.y[0]) / (seen.y[1] - seen.y[0]) * (area.bottom - area.top);
    const parts = (ends) => {
      // The first and the last cell are half as wide: their values are the ends of the axis.
      if (!isEven(ends)) return ends.map((end, i) => [i, 1, i ? ends[i - 1] : 0, end]);
      if (ends.length < 3) return ends.map((end, i) => [i, 1, i ? ends[i - 1] : 0, end]);
      const last = ends.length - 1;
      return [[0, 1, 0, ends[0]], [1, last - 1, ends[0], ends[last - 1]], [last, 1, ends[last - 1], 1]];
    };
    for (const [row, height, low, high] of parts(y.ends)) {
      for (const [column, width, from, to] of parts(x.ends)) {
        // Rows rise upward, and those of the texture downward.
        drawn.save();
        drawn.translate(0, down(low));
        drawn.scale(1, -1);
        drawn.drawImage(this.texture, column, row, width, height, across(from), 0, across(to) - across(from), down(low) - down(high));
        drawn.restore();
      }
    }
    void columns; void rows;
  }

  evenEnd(place, count) { return place === count - 1 ? 1 : (place + 0.5) / (count - 1); }

  stroke(drawn, [from, to]) {
    for (const [width, name] of [[4, "paper"], [2, "ink"]]) {
      drawn.lineWidth = width; drawn.strokeStyle = colour(name);
      drawn.beginPath(); drawn.moveTo(...from); drawn.lineTo(...to); drawn.stroke();
    }
  }

  cross(drawn, [x, y], shade) {
    for (const [width, tone] of [[4, colour("paper")], [2, shade]]) {
      drawn.lineWidth = width; drawn.strokeStyle = tone;
      drawn.beginPath(); drawn.arc(x, y, 7, 0, 2 * Math.PI);
      drawn.moveTo(x - 12, y); drawn.lineTo(x - 4, y); drawn.moveTo(x + 4, y); drawn.lineTo(x + 12, y);
      drawn.moveTo(x, y - 12); drawn.lineTo(x, y - 4); drawn.moveTo(x, y + 4); drawn.lineTo(x, y + 12);
      drawn.stroke();
    }
  }

  drawKey(drawn, area) {
    const { key, told } = this.data, left = area.right + 12;
    drawn.textAlign = "left";
    drawn.textBaseline = "middle";
    drawn.fillStyle = colour("ink");
    if (key.kinds) {
      key.kinds.forEach(([name, rgb], i) => {
        const y = area.top + 10 + 17 * i;
        drawn.fillStyle = rgb ? `rgb(${rgb})` : colour("paper");
        drawn.fillRect(left, y - 6, 12, 12);
        drawn.strokeStyle = colour("faint"); drawn.lineWidth = 0.5; drawn.strokeRect(left, y - 6, 12, 12);
        drawn.fillStyle = colour("ink");
        drawn.fillText(name, left + 17, y, KEY - 32);
      });
      return;
    }
    const height = area.bottom - area.top, count = key.colours.length;
    key.colours.forEach((rgb, i) => {
      drawn.fillStyle = `rgb(${rgb})`;
      drawn.fillRect(left, area.bottom - (i + 1) * height / count, 12, height / count + 0.6);
    });
    const [low, high] = key.range;
    const spread = { linear: (v) => v, log: Math.log, symlog: (v) => Math.asinh(v / key.width) }[key.spread];
    const share = (v) => (spread(v) - spread(low)) / (spread(high) - spread(low));
    drawn.fillStyle = colour("ink");
    const values = key.spread === "symlog" ? [low, 0, high] : ticks(low, high, key.spread === "log");
    for (const value of values) drawn.fillText(short(value), left + 17, area.bottom - share(value) * height);
    drawn.save();
    drawn.translate(left + KEY - 20, (area.top + area.bottom) / 2);
    drawn.rotate(-Math.PI / 2);
    drawn.textAlign = "center";
    drawn.fillText(told, 0, 0);
    drawn.restore();
  }
}
