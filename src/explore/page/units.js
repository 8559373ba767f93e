// The units of the page: one of each kind of quantity, in all views and in the figures that are saved.

import * as view from "./view.js";
import { button, by, element, labelled, select } from "./element.js";

/** What the address has in the units shown, which means nothing in others. */
const SHOWN = ["limits", "range", "brush"];

// The quantities that are counted in other units are asked for anew with all else.
const turn = (units) => view.step({ units: units || null, ...Object.fromEntries(SHOWN.map((it) => [it, null])) });

/** Builds the form, which opens by its tool. */
export function listen({ units }) {
  const form = by("units-form"), tool = by("units-button");
  const all = () => units.map((_, i) => form.elements[`unit-${i}`].value).filter((it) => it).join(",");
  const fields = units.map(({ words, units: names, now }, i) => {
    const written = (unit) => (unit === "deg" ? "°" : unit.replace(/^u/, "µ"));
    const options = [["", "as usual"], ...names.map((it) => [it, written(it)])];
    return labelled(words, select(`unit-${i}`, options, now ?? "", () => {}));
  });
  form.replaceChildren(...fields, element("button", { textContent: "Show in these units" }), button("All as usual", () => turn("")));
  form.addEventListener("submit", (event) => { event.preventDefault(); turn(all()); });
  tool.classList.toggle("changed", units.some(({ now }) => now));
  tool.hidden = !units.length;
  tool.addEventListener("click", () => {
    form.hidden = !form.hidden;
    tool.setAttribute("aria-expanded", String(!form.hidden));
  });
}

/** The options of a command that shows these quantities in the units of the page. */
export const options = (all) => all.filter((it) => it?.asked).map(({ name, asked }) => ` --unit ${name}=${asked}`).join("");
