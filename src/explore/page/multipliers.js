// Multipliers of an orbit as text.

import { short } from "./ticks.js";

const imaginary = (value) => `${short(value, 4)}i`;

/** All of them, pairs of conjugates as one. */
export function multipliers(all) {
  const parts = [];
  all.forEach(([re, im], i) => {
    if (im === 0) parts.push(short(re, 4));
    // The other of a pair follows it, or goes before it.
    else if (!all.slice(0, i).some(([a, b]) => a === re && b === -im)) parts.push(`${short(re, 4)} ± ${imaginary(Math.abs(im))}`);
  });
  return parts.join(", ") || "none";
}
