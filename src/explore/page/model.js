// What the model of the file says of itself, as figures show it.

import { parted } from "./element.js";
import { result } from "./ticks.js";

/** Its starts, section points, states, charts, phase portrait, surface of impacts and outputs, each by name, label, unit and factor. */
export const model = {};

/** Takes over what the file says of its model, before anything is shown. */
export const learn = (told) => Object.assign(model, told);

/** A value in SI of a quantity in the unit shown, without that. */
export const shown = (value, { unit, factor }, digits = 5) => result(value === null || value === undefined ? null : value * factor, unit, digits);

/** The main output of a motion in words. */
export function mainOutput(value) {
  const [name] = parted(model.main_output.label), { unit } = model.main_output, words = name[0].toLowerCase() + name.slice(1);
  return value === null || value === undefined ? `no ${words}` : `${words} ${shown(value, model.main_output)}${unit ? ` ${unit}` : ""}`;
}
