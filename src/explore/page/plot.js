// Curves and points over two axes on a canvas, with ticks; uPlot draws what runs over time.

/** A colour of the page by its name. */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** A canvas with as many pixels as the screen has, and its context in the units of the page. */
export function context(canvas) {
  const { width, height } = canvas.getBoundingClientRect();
  const ratio = window.devicePixelRatio || 1;
  const [across, down] = [width, height].map((length) => Math.max(1, Math.round(length * ratio)));
  if (canvas.width !== across || canvas.height !== down) [canvas.width, canvas.height] = [across, down];
  const drawn = canvas.getContext("2d");
  drawn.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawn.clearRect(0, 0, width, height);
  drawn.font = "12px system-ui, sans-serif";
  return { drawn, width, height };
}

/** Round values between two, some five of them. */
export function ticks(low, high, isLogarithmic = false) {
  if (isLogarithmic && high / low > 30) {
    const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, i) => 10 ** (first + i));
  }
  const rough = (high - low) / 5;
  if (!(rough > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((it) => it * power).find((it) => it >= rough * 0.999);
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(count, 0) }, (_, i) => (first + i) * step);
}

/** A number with as many digits as are needed to tell ticks apart. */
export const short = (value) => String(Number(value.toPrecision(6))).replace("-", "−");

/** The ends of some values with a margin; others where all are the same. */
export function range(values, margin = 0.05) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (Number.isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
  }
  if (low > high) return [0, 1];
  const room = high > low ? margin * (high - low) : Math.abs(low) * 0.1 || 1;
  return [low - room, high + room];
}

/** The frame, ticks and labels of a panel; returns the places of values. */
export function frame(drawn, area, x, y) {
  const share = ({ range: [low, high], log }, value) =>
    log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  const place = {
    x: (value) => area.left + share(x, value) * (area.right - area.left),
    y: (value) => area.bottom - share(y, value) * (area.bottom - area.top),
  };
  drawn.strokeStyle = colour("faint");
  drawn.fillStyle = colour("ink");
  drawn.lineWidth = 1;
  drawn.strokeRect(area.left, area.top, area.right - area.left, area.bottom - area.top);
  drawn.textAlign = "center";
  drawn.textBaseline = "top";
  for (const value of ticks(...x.range, x.log)) {
    const at = place.x(value);
    drawn.beginPath(); drawn.moveTo(at, area.bottom); drawn.lineTo(at, area.bottom + 4); drawn.stroke();
    drawn.fillText(short(value), at, area.bottom + 6);
  }
  drawn.fillText(x.label, (area.left + area.right) / 2, area.bottom + 22);
  drawn.textAlign = "right";
  drawn.textBaseline = "middle";
  for (const value of ticks(...y.range, y.log)) {
    const at = place.y(value);
    drawn.beginPath(); drawn.moveTo(area.left, at); drawn.lineTo(area.left - 4, at); drawn.stroke();
    drawn.fillText(short(value), area.left - 6, at);
  }
  drawn.save();
  drawn.translate(area.left - 52, (area.top + area.bottom) / 2);
  drawn.rotate(-Math.PI / 2);
  drawn.textAlign = "center";
  drawn.fillText(y.label, 0, 0);
  drawn.restore();
  return place;
}
