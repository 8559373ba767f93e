// What the file holds: its axes, constants and outputs.

import { element, folded, parted, table } from "./element.js";
import { short } from "./ticks.js";

const shown = (value, { factor, unit }) => `${short(value * factor)}${unit ? ` ${unit}` : ""}`;

/** Tables of what the file holds. */
export function facts(file) {
  const axes = file.axes.map((it) => [parted(it.label)[0], it.name, shown(it.values[0], it), shown(it.values.at(-1), it), it.values.length]);
  const constants = () => file.constants.map((it) => [parted(it.label)[0], it.name, shown(it.value, it)]);
  const outputs = () => file.outputs.map((it) => [parted(it.label)[0], it.name, it.unit || "–"]);
  const made = [];
  if (axes.length) made.push(table("Axes", ["axis", "name", "from", "to", "values"], axes));
  made.push(folded(`Constants (${file.constants.length})`, ["constant", "name", "value"], constants));
  made.push(folded(`Outputs (${file.outputs.length})`, ["output", "name", "unit"], outputs));
  return made;
}
