// The numbers of motions in tables: the key numbers beside each other, and the long ones.

import { element, folded, table } from "./element.js";
import { result, short } from "./ticks.js";

const MILLI = 1e3;
/** The key numbers: what, unit, output and factor. */
const KEY = [
  ["Speed", "mm/s", "progression_speed", MILLI],
  ["Progression per cycle", "mm", "progression_per_cycle", MILLI],
  ["Work of the drive per cycle", "mJ", "work_net", MILLI],
  ["Positive work per cycle", "mJ", "work_positive", MILLI],
  ["Friction loss per cycle", "mJ", "friction_loss", MILLI],
  ["Damper loss per cycle", "mJ", "damper_loss", MILLI],
  ["Power (positive work)", "mW", "power", MILLI],
  ["Energy per metre", "J/m", "energy_per_metre", 1],
  ["Cost of transport", "", "cost_of_transport", 1],
  ["Impacts per cycle", "", "impacts_per_cycle", 1],
  ["Share of time at rest", "%", "stick_share", 100],
  ["Peak contact force", "N", "peak_contact_force", 1],
  ["Lyapunov exponent", "1/s", "lyapunov_exponent", 1],
];

const number = (value, unit, factor) => result(value === null || value === undefined ? null : value * factor, unit);

/** A complex number in words. */
export function complex([re, im]) {
  if (re === null || im === null) return "–";
  // Multipliers are known to some 1e-12.
  if (Math.hypot(re, im) < 1e-12) return "≈ 0";
  return im === 0 ? short(re, 4) : `${short(re, 4)} ${im < 0 ? "−" : "+"} ${short(Math.abs(im), 4)} i`;
}

/** The key numbers of motions, each a column with its heading; a dash stands where there is no value. */
export function keyNumbers(motions) {
  const orbits = motions.map(({ it }) => it.simulate.orbit);
  const rows = [["Motion", ...orbits.map((it) => it.outcome)], ["Period (cycles)", ...orbits.map((it) => (it.period ? String(it.period) : "–"))]];
  for (const [words, unit, name, factor] of KEY) rows.push([unit ? `${words} (${unit})` : words, ...orbits.map((it) => number(it[name], unit, factor))]);
  const most = Math.max(0, ...orbits.map((it) => (it.multipliers || []).length));
  for (let i = 0; i < most; i++) rows.push([`Multiplier ${i + 1}`, ...orbits.map((it) => (it.multipliers?.[i] ? complex(it.multipliers[i]) : "–"))]);
  const head = ["Key numbers", ...motions.map(({ name }) => name)];
  return element("div", { className: "key-numbers" }, table("Key numbers", head, rows));
}

/** The tables of a motion that open on demand; `open` says which are. */
export function tables({ simulate, stroboscopic }, open) {
  const { orbit, events, parameters } = simulate;
  const numbers = Object.entries(orbit).filter(([, value]) => typeof value === "number" || value === null);
  // These are pasted into programs: their minus is that of ASCII.
  const text = (value) => (value === null ? "no value" : String(value));
  const all = [
    [`Events of the first cycles, from the start (${events.length})`, ["t (s)", "event", "r (mm)", "y1 (mm/s)", "x2 (mm)", "y2 (mm/s)"],
      () => events.map((it) => [short(it.t), it.kind, ...[it.r, it.y1, it.x2, it.y2].map((value) => short(value * MILLI))])],
    [`Section points (${stroboscopic.length})`, ["point", "r (mm)", "y1 (mm/s)", "y2 (mm/s)"],
      () => stroboscopic.map((point, i) => [String(i + 1), ...point.map((value) => short(value * MILLI))])],
    ["Numbers of the orbit (SI)", ["output", "value"], () => numbers.map(([name, value]) => [name, text(value)])],
    ["Parameters (SI)", ["parameter", "value"], () => Object.entries(parameters).map(([name, value]) => [name, text(value)])],
  ];
  return all.map((it, i) => folded(...it, open[i]));
}
