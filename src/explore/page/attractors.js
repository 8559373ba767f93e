// The attractors of a file whose axes are starts: what each is, its share of the starts, and its section points over the basins.

import * as ask from "./ask.js";
import { button, by, element, say, table } from "./element.js";
import { legend } from "./legend.js";
import { model, shown } from "./model.js";
import { page } from "./shown.js";
import { short } from "./ticks.js";

/** Attractors that are told of at most. */
const MOST = 16;
const NAME = "attractor";

/** Whether all axes of a file are coordinates of the start. */
export const isBasin = (file) => file.axes.length > 1 && file.axes.every(({ name }) => name.startsWith("start_"));

// The cells of each kind of a map.
function cellsOf({ key, values }) {
  const all = key.kinds.map(() => []);
  values.forEach((kind, cell) => all[kind]?.push(cell));
  return all;
}

// The section points of a motion over the axes of the map; none where an axis is no coordinate of the section.
function over({ x, y }, { stroboscopic }) {
  const at = [x, y].map(({ name }) => model.section.findIndex((it) => it.name === name.replace(/^start_/, "section_")));
  return at.includes(-1) ? [] : stroboscopic.map((point) => at.map((i) => point[i]));
}

/** Finds the attractors of the map as it is now: the motion of one start of each; `choose` shows the motion of a point. */
export async function find(data, choose, signal) {
  by("attractors").replaceChildren();
  if (page.map.marks.attractors.length) page.map.set({ attractors: [] });
  if (!isBasin(page.file) || page.choices.chosen().of !== NAME || !data.key.kinds) return;
  const { x, y } = data, columns = x.values.length, all = cellsOf(data), marks = [], rows = [];
  for (const [i, [name, colour]] of data.key.kinds.slice(0, MOST).entries()) {
    if (!all[i].length || !colour) continue;
    // A start in the midst of those that lead there.
    const cell = all[i][all[i].length >> 1], point = [x.values[cell % columns], y.values[Math.floor(cell / columns)]];
    const asked = { ...page.choices.held(), ...page.choices.from(), [x.name]: point[0], [y.name]: point[1] };
    const motion = await ask.object("/api/motion", asked, signal), { orbit } = motion.simulate;
    marks.push(...over(data, motion).map((at) => ({ at, colour })));
    rows.push(row(name, colour, orbit, all[i].length / data.values.length, () => choose(point)));
  }
  const head = ["attractor", "motion", model.main_output.label, "share of starts", "its motion"];
  by("attractors").replaceChildren(element("h2", { textContent: "Attractors of the file" }), table("Attractors of the file", head, rows));
  by("basin-empty").hidden = true;
  page.map.set({ attractors: marks });
  legend();
  say(`${rows.length} attractors`);
}

function row(name, colour, orbit, share, choose) {
  const swatch = element("span", { className: "swatch" });
  swatch.style.background = `rgb(${colour})`;
  const motion = orbit.outcome === "periodic" ? `periodic, period ${orbit.period}` : orbit.outcome;
  const show = button("Show", choose, { ariaLabel: `Show the motion of ${name}` });
  return [element("span", {}, swatch, name), motion, shown(orbit[model.main_output.name], model.main_output), `${short(100 * share, 3)} %`, show];
}
