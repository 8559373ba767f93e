// The form of a case by numbers: its axes, its constants and its start.

import { by, element, labelled } from "./element.js";

/** A number of the form that is this near to a value of the axis, relative to it, is that value. */
const SAME = 1e-9;

/** Builds the form over a file; `choose` is called with the coordinates in SI. */
export function caseForm(file, choose) {
  const field = (it) => element("input", { type: "number", step: "any", name: it.name, required: true });
  const fields = (all) => all.map((it) => labelled(it.label, field(it)));
  const group = (words, all) => element("fieldset", {}, element("legend", { textContent: words }), ...fields(all));
  const groups = [["Axes", file.axes], ["Constants", file.constants]].filter(([, all]) => all.length).map(([words, all]) => group(words, all));
  by("case-form").replaceChildren(...groups, element("button", { textContent: "Compute this case", id: "case-button" }));
  by("case-form").addEventListener("submit", (event) => {
    event.preventDefault();
    choose(read(file));
  });
}

// The axes, and the constants that are other than in the file.
function read({ axes, constants }) {
  const value = (it, known) => {
    const typed = Number((Number(by("case-form").elements[it.name].value) / it.factor).toPrecision(14));
    const near = known.find((one) => Math.abs(one - typed) <= SAME * Math.abs(one));
    return near ?? typed;
  };
  const all = axes.map((it) => [it.name, value(it, it.values)]);
  const others = constants.map((it) => [it.name, value(it, [it.value]), it.value]);
  return Object.fromEntries([...all, ...others.filter(([, now, usual]) => now !== usual)]);
}

/** Puts a case into the form; what it does not say is as in the file. */
export function fillForm({ axes, constants }, coordinates) {
  const put = (it, value) => { by("case-form").elements[it.name].value = String(Number((value * it.factor).toPrecision(12))); };
  axes.forEach((it) => put(it, coordinates[it.name] ?? it.values[0]));
  constants.forEach((it) => put(it, coordinates[it.name] ?? it.value));
}
