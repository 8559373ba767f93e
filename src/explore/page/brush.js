// The selection that marks cases in the map and points in the trade-off: a rectangle in the one or the other.

import * as view from "./view.js";
import { parted } from "./element.js";
import { result } from "./ticks.js";

/** The selection in the address: its `plane` ("map" or "trade-off") and the ranges of its two axes; none where there is none. */
export function selection() {
  const [plane, text] = (view.text("brush") || "").split(":"), all = text?.split(",").map(Number);
  if (!["map", "trade-off"].includes(plane) || all?.length !== 4 || !all.every(Number.isFinite)) return null;
  return { plane, ranges: [all.slice(0, 2), all.slice(2)] };
}

/** Sets the selection, or removes it. */
export function brush(plane, ranges) {
  view.set({ brush: ranges && `${plane}:${ranges.flat().map((it) => Number(it.toPrecision(12))).join(",")}` });
}

/** The mask of the cells whose case lies in ranges of the axes of a map, in SI. */
export function within({ x, y }, [across, up]) {
  const isIn = ([low, high], value) => value >= low && value <= high;
  const columns = x.values.map((it) => isIn(across, it)), rows = y.values.map((it) => isIn(up, it));
  const mask = new Uint8Array(columns.length * rows.length);
  rows.forEach((isRow, row) => isRow && columns.forEach((isColumn, column) => { mask[row * columns.length + column] = isColumn ? 1 : 0; }));
  return mask;
}

/** What a mask selects, in a sentence, with the ranges of price and speed. */
export function told(mask, { prices, speeds, price, speed }) {
  let [count, shown] = [0, 0];
  const ends = [[Infinity, -Infinity], [Infinity, -Infinity]];
  for (let i = 0; i < mask.length; i++) {
    if (!mask[i]) continue;
    count++;
    if (Number.isNaN(prices[i]) || Number.isNaN(speeds[i])) continue;
    shown++;
    [prices[i], speeds[i]].forEach((it, axis) => { ends[axis] = [Math.min(ends[axis][0], it), Math.max(ends[axis][1], it)]; });
  }
  const without = count - shown ? `; ${count - shown} of them take no part in the trade-off` : "";
  const part = ({ label }, all) => {
    const [name, unit] = parted(label), [low, high] = all.map((it) => result(it, unit, 4));
    return `${name} from ${low} to ${high} ${unit}`.trim();
  };
  return `${count} of ${mask.length} cases are selected${without}${shown ? `: ${part(price, ends[0])}; ${part(speed, ends[1])}` : ""}.`;
}
