// The cells of a plane as pixels: each pixel shows the cell in which it lies, whatever the widths of the cells.

import { colours } from "./plot.js";

/** How much of the colour of a cell that is not selected stays. */
const FADED = 0.22;

/** Cells with their colours; `x` and `y` have the end of each cell as a share of the axis. */
export class Cells {
  constructor({ x, y, colours: bytes }) {
    Object.assign(this, { ends: [x.ends, y.ends], mask: null, layer: document.createElement("canvas") });
    this.own = new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
    this.hasGaps = this.own.some((it) => it >>> 24 === 0);
    this.recolour();
  }

  /** Fades the cells whose number is not in the mask; none without one. */
  select(mask) {
    this.mask = mask;
    this.recolour();
  }

  /** Takes the colours of the page as they are now. */
  recolour() {
    this.shown = this.mask ? this.faded() : this.own;
    this.key = null;
  }

  faded() {
    const paper = parseInt(colours().paper.slice(1), 16);
    const [red, green, blue] = [paper >> 16, (paper >> 8) & 255, paper & 255].map((it) => it * (1 - FADED));
    return this.own.map((it, cell) => {
      if (this.mask[cell] || it >>> 24 === 0) return it;
      const [r, g, b] = [red + FADED * (it & 255), green + FADED * ((it >> 8) & 255), blue + FADED * ((it >> 16) & 255)];
      return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
    });
  }

  /** How many cells there are for each pixel that is seen, along the axis that has more. */
  crowding(area, seen, ratio) {
    const [x, y] = seen;
    const [across, up] = [(x[1] - x[0]) * this.ends[0].length, (y[1] - y[0]) * this.ends[1].length];
    return Math.max(across / (area.right - area.left), up / (area.bottom - area.top)) / ratio;
  }

  // The cell of each of `count` pixels along an axis.
  places(ends, [low, high], count) {
    const all = new Uint32Array(count);
    let cell = 0;
    for (let i = 0; i < count; i++) {
      const share = low + ((i + 0.5) / count) * (high - low);
      while (cell < ends.length - 1 && ends[cell] < share) cell++;
      all[i] = cell;
    }
    return all;
  }

  /** Paints what is seen of the cells over an area. */
  paint(drawn, area, seen, ratio) {
    const [wide, high] = [area.right - area.left, area.bottom - area.top];
    const size = [wide, high].map((it) => Math.max(1, Math.round(it * ratio)));
    const key = [...size, ...seen.flat()].join();
    // Marks move far more often than the cells.
    if (key !== this.key) this.fill(size, seen);
    this.key = key;
    if (this.hasGaps) hatch(drawn, area);
    drawn.drawImage(this.layer, area.left, area.top, wide, high);
  }

  fill([width, height], [x, y]) {
    const image = new ImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    const columns = this.places(this.ends[0], x, width), rows = this.places(this.ends[1], y, height);
    for (let j = 0; j < height; j++) {
      const first = rows[height - 1 - j] * this.ends[0].length;
      for (let i = 0, at = j * width; i < width; i++, at++) pixels[at] = this.shown[first + columns[i]];
    }
    [this.layer.width, this.layer.height] = [width, height];
    this.layer.getContext("2d").putImageData(image, 0, 0);
  }
}

/** Hatches an area in which there are no values. */
export function hatch(drawn, { left, top, right, bottom }) {
  const tile = document.createElement("canvas"), shades = colours();
  [tile.width, tile.height] = [8, 8];
  const on = tile.getContext("2d");
  on.fillStyle = shades.panel;
  on.fillRect(0, 0, 8, 8);
  on.strokeStyle = shades.line;
  on.lineWidth = 1;
  on.beginPath();
  for (const at of [-8, 0, 8]) { on.moveTo(at, 8); on.lineTo(at + 8, 0); }
  on.stroke();
  drawn.fillStyle = drawn.createPattern(tile, "repeat");
  drawn.fillRect(left, top, right - left, bottom - top);
}
