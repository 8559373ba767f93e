// The key numbers of a motion as a strip: what it is, and its first outputs with their units.

import { element, marked, parted } from "./element.js";
import { model, shown } from "./model.js";

/** Numbers of the strip beside the outcome. */
const MOST = 5;
/** Significant digits; the table has more. */
const DIGITS = 4;
/** The rest of the key numbers follow in a table; these kinds go first, in this order. */
const FIRST = [/^power$/, /impacts_per_cycle$/, /peak/, /stick/, /lyapunov/];

/** The outputs of the strip: the main one, the first cost, and what is asked for first of a motion with impacts. */
function chosen() {
  const { key_outputs: all, main_output: main, costs } = model, wanted = [main.name, costs[0]?.name];
  const found = [...wanted.map((name) => all.find((it) => it.name === name)), ...FIRST.map((kind) => all.find((it) => kind.test(it.name)))];
  return [...new Set([...found, ...all])].filter((it) => it).slice(0, MOST);
}

function cell(name, value, unit = "", more = {}) {
  const number = element("dd", {}, element("span", {}, value), ...(unit ? [element("span", { className: "unit", textContent: unit })] : []));
  return element("div", more, element("dt", {}, ...marked(name)), number);
}

/** The strip of an orbit; of one that is not known yet, what is being found. */
export function strip(motion) {
  if (!motion) return element("dl", { className: "strip" }, cell("Motion", "…", "", { className: "outcome" }), ...chosen().map((it) => cell(parted(it.label)[0], "…")));
  const { simulate: { orbit } } = motion, isPeriodic = orbit.outcome === "periodic";
  const outcome = cell("Motion", isPeriodic ? `period ${orbit.period}` : orbit.outcome, "", { className: `outcome ${isPeriodic ? "periodic" : "other"}` });
  const others = chosen().map((it) => {
    const [name] = parted(it.label), value = shown(orbit[it.name], it, DIGITS);
    return cell(name, value, /\d/.test(value) ? parted(it.label)[1] : "");
  });
  return element("dl", { className: "strip" }, outcome, ...others);
}
