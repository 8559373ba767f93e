// The forms of a case and of a line by numbers.

import { by, element, labelled } from "./element.js";

/** A number of the form that is this near to a value of the axis, relative to it, is that value. */
const SAME = 1e-9;

// The coordinates of the start that no axis of the file has.
const starts = ({ axes, model }) => model.starts.filter(({ name }) => axes.every((it) => it.name !== name));

// The value of a field in SI: one of those that are `known` where it is that near.
function value(input, { factor }, known) {
  const typed = Number((Number(input.value) / factor).toPrecision(14));
  return known.find((one) => Math.abs(one - typed) <= SAME * Math.abs(one)) ?? typed;
}

const put = (input, it, si) => { input.value = si === undefined ? "" : String(Number((si * it.factor).toPrecision(12))); };
// The axes, and what was drawn where there are none.
const varied = ({ axes, draws }) => [...axes, ...(draws || []).map((it) => ({ ...it, values: [] }))];

/** Tells at the field of the upper end that it is not above the lower one; whether it is so. */
export function isReversed(low, high, words) {
  const isWrong = Number(low.value) >= Number(high.value);
  if (!isWrong) return false;
  high.setCustomValidity(`${words}: “to” must be greater than “from”.`);
  high.reportValidity();
  // Another number is judged when it is given.
  for (const it of [low, high]) it.addEventListener("input", () => high.setCustomValidity(""), { once: true });
  return true;
}

/** Builds the form over a file; `choose` is called with the coordinates in SI. */
export function caseForm(file, choose) {
  const field = (it) => element("input", { type: "number", step: "any", name: it.name, required: true });
  const fields = (all) => all.map((it) => labelled(it.label, field(it)));
  const group = (words, all) => element("fieldset", {}, element("legend", { textContent: words }), ...fields(all));
  const groups = [["Axes", file.axes], ["Draws", varied(file).slice(file.axes.length)], ["Constants", file.constants]].filter(([, all]) => all.length).map(([words, all]) => group(words, all));
  const usual = file.inherits ? "at the motion of the nearest case where all are empty" : "as the study says where all are empty";
  groups.push(group("Start (optional)", starts(file)));
  groups.at(-1).append(element("p", { className: "note", textContent: `The case starts ${usual}. A field that is empty beside others is as the study says.` }));
  for (const { name } of starts(file)) groups.at(-1).querySelector(`[name=${name}]`).required = false;
  by("case-form").replaceChildren(...groups, element("button", { textContent: "Compute this case", id: "case-button" }));
  by("case-form").addEventListener("submit", (event) => {
    event.preventDefault();
    choose(read(file));
  });
}

// The axes, the constants that are other than in the file, and the start as far as it is given.
function read(file) {
  const { constants } = file, axes = varied(file), field = ({ name }) => by("case-form").elements[name];
  const all = axes.map((it) => [it.name, value(field(it), it, it.values)]);
  const others = constants.map((it) => [it.name, value(field(it), it, [it.value]), it.value]);
  const given = starts(file).filter((it) => field(it).value !== "").map((it) => [it.name, value(field(it), it, [])]);
  return Object.fromEntries([...all, ...others.filter(([, now, usual]) => now !== usual), ...given]);
}

/** Puts a case into the form; what it does not say is as in the file. */
export function fillForm(file, coordinates) {
  const { constants } = file, axes = varied(file), field = ({ name }) => by("case-form").elements[name];
  axes.forEach((it) => put(field(it), it, coordinates[it.name] ?? it.values[0]));
  constants.forEach((it) => put(field(it), it, coordinates[it.name] ?? it.value));
  for (const it of starts(file)) {
    if (it.name in coordinates) put(field(it), it, coordinates[it.name]); else field(it).value = "";
  }
}

/** Builds the form of a line over the axes of a map; `follow` is called with its ends in SI. */
export function lineForm(axes, follow) {
  const ends = ["from", "to"].map((end) => axes.map((axis) => element("input", { type: "number", step: "any", required: true, name: `${end}_${axis.name}` })));
  const group = (words, all) => element("fieldset", {}, element("legend", { textContent: words }), ...all.map((it, i) => labelled(axes[i].label, it)));
  by("line-form").replaceChildren(group("From", ends[0]), group("To", ends[1]), element("button", { textContent: "Follow this line" }));
  by("line-form").onsubmit = (event) => {
    event.preventDefault();
    follow(...ends.map((all) => all.map((it, i) => value(it, axes[i], axes[i].values))));
  };
  return (line) => ends.forEach((all, end) => all.forEach((it, i) => put(it, axes[i], line[end][i])));
}
