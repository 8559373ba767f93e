// The numbers of motions in tables: the key numbers beside each other, and the long ones.

import { element, folded, table } from "./element.js";
import { model, shown } from "./model.js";
import { short } from "./ticks.js";

/** A complex number in words. */
export function complex([re, im]) {
  if (re === null || im === null) return "–";
  // Multipliers are known to some 1e-12.
  if (Math.hypot(re, im) < 1e-12) return "≈ 0";
  return im === 0 ? short(re, 4) : `${short(re, 4)} ${im < 0 ? "−" : "+"} ${short(Math.abs(im), 4)} i`;
}

/** The multipliers of an orbit in words, pairs of conjugates as one. */
export function multipliers(all) {
  const isSecond = ([re, im], i) => im && all.slice(0, i).some(([a, b]) => a === re && b === -im);
  const words = ([re, im]) => (im ? `${short(re, 4)} ± ${short(Math.abs(im), 4)} i` : complex([re, im]));
  return all.filter((it, i) => !isSecond(it, i)).map(words).join("; ") || "none";
}

/** An output of an orbit with its standard error where that is above zero; nothing is below a rate that is minus infinity, as of a direction that is lost. */
function withError(orbit, it, none) {
  const value = orbit[it.name], error = orbit[it.error];
  if (value === null && none) return none;
  return error > 0 ? `${shown(value, it)} ± ${short(error * it.factor, 2)}` : shown(value, it);
}

/** The key numbers of motions, each a column with its heading; a dash stands where there is no value. */
export function keyNumbers(motions) {
  const orbits = motions.map(({ it }) => it.simulate.orbit);
  const rows = [["Motion", ...orbits.map((it) => it.outcome)], ["Period (cycles)", ...orbits.map((it) => (it.period ? String(it.period) : "–"))]];
  for (const it of model.key_outputs) rows.push([it.label, ...orbits.map((orbit) => withError(orbit, it))]);
  for (const it of model.spectrum) {
    // Only of motions of which all exponents are asked for.
    if (orbits.some((orbit) => orbit[it.name] !== undefined)) rows.push([it.label, ...orbits.map((orbit) => withError(orbit, it, "−∞"))]);
  }
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
    [`Events of the first cycles, from the start (${events.length})`, ["t (s)", "event", ...model.state.map((it) => it.label)],
      () => events.map((it) => [short(it.t), it.kind, ...model.state.map(({ name, factor }) => short(it[name] * factor))])],
    [`Section points (${stroboscopic.length})`, ["point", ...model.section.map((it) => it.label)],
      () => stroboscopic.map((point, i) => [String(i + 1), ...point.map((value, at) => short(value * model.section[at].factor))])],
    ["Numbers of the orbit (SI)", ["output", "value"], () => numbers.map(([name, value]) => [name, text(value)])],
    ["Parameters (SI)", ["parameter", "value"], () => Object.entries(parameters).map(([name, value]) => [name, text(value)])],
  ];
  return all.map((it, i) => folded(...it, open[i]));
}
