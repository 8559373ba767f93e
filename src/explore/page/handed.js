// The commands of the figures of the map and of the trade-off, and their saving.

import * as colouring from "./colouring.js";
import { isBasin, isShown } from "./attractors.js";
import { by } from "./element.js";
import { handOver, quoted, save } from "./keep.js";
import { page, price } from "./shown.js";
import { options } from "./units.js";

// A number with as many digits as tell the ends of a range apart to a thousandth, with its unit.
function end(value, [low, high], unit) {
  const digits = 4 + Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low)));
  return `${Number(value.toPrecision(Math.max(digits, 4)))}${unit ? ` ${unit === "°" ? "deg" : unit}` : ""}`;
}

const option = (name, ends, unit) => ` --limits ${quoted(`${name}=${ends.map((it) => end(it, ends, unit)).join(",")}`)}`;

// The ends of the axes as they are seen, as options of the command; none where all is seen.
function limits() {
  const { map, file } = page;
  if (!map.window) return "";
  return [map.data.x, map.data.y].map((axis, i) => {
    const unit = file.axes.find((it) => it.name === axis.name)?.unit;
    return option(axis.name, map.window[i].map((share) => map.value(axis, share)), unit);
  }).join("");
}

// How the values are coloured, where that is not as usual.
function colours(of) {
  const { map, scale, ends } = colouring.asked(), { unit } = page.file.outputs.find((it) => it.name === of);
  const parts = [map && ` --colour-map ${of}=${map}`, scale && ` --scale ${of}=${scale}`, ends && option(of, ends, unit)];
  return page.map.data.key.kinds ? "" : parts.filter((it) => it).join("");
}

// The same for a figure that is saved here.
function ends() {
  const { map } = page, { x, y } = map.data;
  if (!map.window) return {};
  const [across, up] = [x, y].map((axis, i) => map.window[i].map((share) => Number(map.value(axis, share).toPrecision(8))).join(","));
  return { "limits-x": across, "limits-y": up };
}

/** Names what is saved: the part of the map that is seen. */
export function nameSaving() {
  for (const format of ["pdf", "svg"]) {
    const it = by(`${format}-button`), words = `Save ${page.map.window ? "this part of the " : ""}${it.dataset.words}`;
    Object.assign(it, { ariaLabel: words, title: words });
  }
}

// Basins by their attractors have a figure of their own, with the marks over them.
const kind = () => (isBasin(page.file) && page.choices.chosen().of === "attractor" && isShown() ? "basin" : "map");

/** Saves the map as it is asked for. */
export function saveMap(format, pressed) {
  const curves = page.curves ? { curves: 1 } : {};
  const { of, ...plane } = page.choices.asked();
  const asked = kind() === "basin" ? { kind: "basin", stored: 1, ...plane } : { kind: "map", of, ...plane, ...curves, ...colouring.saved(page.file) };
  return save({ ...asked, ...ends() }, format, pressed);
}

/** Hands the commands of the map and of the trade-off over. */
export function handMaps() {
  const { file, choices } = page, { of, x, y } = choices.chosen(), { sweep } = choices.sweep();
  const places = Object.entries(choices.held()).map(([name, value]) => ` --at ${name}=${value}`).join("") + (sweep ? ` --sweep ${sweep}` : "");
  const figure = (kind, more) => `capsulemap figure ${quoted(file.file)} --kind ${kind} ${more}${places}`;
  const shown = options([x, y].map((name) => choices.axis(name))), out = file.outputs.find((it) => it.name === of);
  if (kind() === "basin") handOver("map", "Figure of the basins", figure("basin", `--x ${x} --y ${y}${shown}${limits()}`));
  else handOver("map", "Figure of the map", figure("map", `--of ${of} --x ${x} --y ${y}${page.curves ? " --curves" : ""}${options([out])}${shown}${colours(of)}${limits()}`));
  handOver("trade-off", "Figure of the trade-off", price() && sweep !== "difference" && figure("trade-off", `--of ${price()}${options([file.model.main_output, file.model.costs.find((it) => it.name === price())])}`));
}
