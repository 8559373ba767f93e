// How values are spread along the colours of a map, and the round values beside them.

import { alike, ticks } from "./ticks.js";

/** The place of a value before the ends of the scale are taken off. */
export const bent = ({ spread, width }) => ({ linear: (v) => v, log: Math.log, symlog: (v) => Math.asinh(v / width) })[spread];

/** The share of the bar at which a value lies. */
export function share(key) {
  const to = bent(key), [low, high] = key.range.map(to);
  return (value) => (to(value) - low) / (high - low);
}

/** Values along a bar of some height with their texts, those that stand clear of each other. */
export function numbers(key, height) {
  const [low, high] = key.range, at = share(key);
  if (key.spread !== "symlog") {
    const { values, text } = ticks(low, high, key.spread === "log", height / 34);
    return values.map((it) => [it, text(it)]);
  }
  const most = Math.max(Math.abs(low), Math.abs(high)), powers = [];
  for (let power = Math.floor(Math.log10(most)); 10 ** power > key.width / 3; power--) powers.push(10 ** power, -(10 ** power));
  const taken = [];
  for (const value of [0, ...powers].filter((it) => it >= low && it <= high)) {
    if (taken.every((it) => Math.abs(at(it) - at(value)) * height > 18)) taken.push(value);
  }
  const text = alike(taken);
  return taken.map((it) => [it, text(it)]);
}
