// Many points as pixels: each pixel is the darker the more points lie there, and knows the last of them.

/** The opacity that each point adds, and the radius of a point [CSS pixels], by how many points there are. */
const SIZES = [[2000, 0.6, 2.2], [30000, 0.5, 1.5], [200000, 0.45, 1], [Infinity, 0.4, 0.5]];

const channels = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

// The pixels of a point, about its middle.
function stencil(radius) {
  const reach = Math.max(0, Math.ceil(radius - 0.5)), all = [];
  for (let y = -reach; y <= reach; y++) for (let x = -reach; x <= reach; x++) if (x * x + y * y <= radius * radius + 0.3) all.push([x, y]);
  return all;
}

/** The points of two columns of numbers over an area of a canvas. */
export class Cloud {
  constructor(area, ratio, place, xs, ys) {
    const [width, height] = [area.right - area.left, area.bottom - area.top].map((it) => Math.max(1, Math.round(it * ratio)));
    Object.assign(this, { area, ratio, width, height, xs, ys, place, owner: new Int32Array(width * height), layers: [] });
    const size = SIZES.find(([most]) => xs.length <= most);
    [this.opacity, this.stencil] = [size[1], stencil(size[2] * ratio)];
  }

  // How many points lie on each pixel of those that are `taken`.
  counts(taken) {
    const { area, ratio, width, height } = this, counts = new Uint16Array(width * height);
    for (let cell = 0; cell < this.xs.length; cell++) {
      if (!taken(cell) || Number.isNaN(this.xs[cell]) || Number.isNaN(this.ys[cell])) continue;
      const x = Math.round((this.place.x(this.xs[cell]) - area.left) * ratio), y = Math.round((this.place.y(this.ys[cell]) - area.top) * ratio);
      for (const [dx, dy] of this.stencil) {
        const [i, j] = [x + dx, y + dy];
        if (i < 0 || j < 0 || i >= width || j >= height) continue;
        counts[j * width + i]++;
        this.owner[j * width + i] = cell + 1;
      }
    }
    return counts;
  }

  /** Adds the points that are `taken`, in a colour, over those before. */
  add(taken, colour) {
    const counts = this.counts(taken), image = new ImageData(this.width, this.height), [r, g, b] = channels(colour);
    const pixels = new Uint32Array(image.data.buffer), rgb = (b << 16) | (g << 8) | r;
    for (let i = 0; i < counts.length; i++) {
      if (counts[i]) pixels[i] = (rgb | (Math.round(255 * (1 - (1 - this.opacity) ** counts[i])) << 24)) >>> 0;
    }
    const layer = document.createElement("canvas");
    [layer.width, layer.height] = [this.width, this.height];
    layer.getContext("2d").putImageData(image, 0, 0);
    this.layers.push(layer);
  }

  /** Whether it was made for this area and these pixels. */
  fits(area, ratio) { return ["left", "top", "right", "bottom"].every((it) => area[it] === this.area[it]) && ratio === this.ratio; }

  /** Draws what was added. */
  draw(drawn) {
    const { left, top, right, bottom } = this.area;
    this.layers.forEach((layer) => drawn.drawImage(layer, left, top, right - left, bottom - top));
  }

  /** The number of the point nearest to a place of the canvas, within some pixels; none where there is none. */
  near(x, y, reach = 7) {
    const [i, j] = [(x - this.area.left) * this.ratio, (y - this.area.top) * this.ratio].map(Math.round);
    const far = Math.round(reach * this.ratio);
    let [best, found] = [Infinity, null];
    for (let dy = -far; dy <= far; dy++) {
      for (let dx = -far; dx <= far; dx++) {
        const [column, row] = [i + dx, j + dy], away = dx * dx + dy * dy;
        if (column < 0 || row < 0 || column >= this.width || row >= this.height || away >= best) continue;
        const owner = this.owner[row * this.width + column];
        if (owner) [best, found] = [away, owner - 1];
      }
    }
    return found;
  }
}
