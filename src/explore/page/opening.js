// What the page shows of a file before anything is asked for: a map, a diagram over one axis, or cases without axes.

import * as tabs from "./tabs.js";
import * as view from "./view.js";
import { button, by, element } from "./element.js";
import { isBasin } from "./attractors.js";
import { icon } from "./icons.js";
import { page, price } from "./shown.js";

// Words where a view shows nothing yet, with what to do about it.
function empty(id, name, words, ...actions) {
  by(id).replaceChildren(icon(name), element("p", { textContent: words }), ...(actions.length ? [element("p", { className: "buttons" }, ...actions)] : []));
}

/** The line along the only axis of a file. */
const whole = ({ axes: [axis] }) => [axis.values[0], axis.values.at(-1)].map((it) => view.written({ [axis.name]: it })).join("~");

/** Fills the views that show nothing yet; `largest` shows the case whose value on the map is largest. */
export function wait(file, largest) {
  const hasMap = file.axes.length > 1, draw = () => by("line-button").click();
  const how = { 0: file.draws?.length ? "Click a case for its motion, or compute one by its numbers." : "Compute a case by its numbers.", 1: "Click a value of the diagram for its motion, or compute a case by its numbers." }[file.axes.length];
  const most = button("Show the case with the largest value", largest);
  empty("motion-empty", "motion", how || "Click a cell of the map.", ...(hasMap && !isBasin(file) ? [most] : []));
  const along = button("Compute along the whole axis", () => view.step({ line: whole(file), ...tabs.pane("line") }));
  if (hasMap) empty("line-empty", "line", "A line over the map gives the bifurcation diagram along it, while it is computed.", button("Draw a line", draw));
  else empty("line-empty", "line", "The diagram along the axis can be computed here, from either end and with other starts than the file has.", along);
  empty("basin-empty", "basin", "The basins at the parameters of a case: choose the case, then ask for them with Basin.");
  empty("branches-empty", "special", "Branches of periodic orbits, stable or not: ask for them below the bifurcation diagram of a line with “Follow branches”.");
}

/** Lays the page out for the file; true where it has a map. */
export function lay(file) {
  const hasMap = file.axes.length > 1;
  document.body.classList.toggle("without-map", !hasMap);
  if (isBasin(file) && !view.text("at")) tabs.begin("basin");
  if (hasMap) return true;
  // There are no tools of a map.
  document.querySelector("#motion-section > .buttons").prepend(by("basin-button"));
  for (const it of ["choices", "map-place"]) by(it).hidden = true;
  by("whole-place").hidden = false;
  tabs.remove("trade-off");
  if (!file.axes.length) tabs.remove("line");
  by("form-place").open = true;
  // The diagram is what such a file is: it stands where other files have their map.
  if (file.diagrams.length) by("map-heading").textContent = "Diagram";
  else {
    by("map-heading").textContent = "Cases";
    if (file.draws?.length) return false;
    by("whole-place").append(element("p", { className: "empty", textContent: `These are ${file.cases.toLocaleString("en")} cases without axes: compute a case by its numbers.` }));
  }
  if (!file.diagrams.length) document.body.dataset.ready = "true";
  return false;
}

/** Shows the trade-off where a person turns to it. */
export const turnToTradeOff = (prices) => { if (!price() && prices.length) view.step({ trade: prices[0][0], brush: null }); };

/** The case of the map whose value is largest, in either direction. */
export function largest() {
  const { values, x } = page.map.data, size = (it) => (Number.isFinite(it) ? Math.abs(it) : -1);
  let best = 0;
  for (let i = 1; i < values.length; i++) if (size(values[i]) > size(values[best])) best = i;
  return [x.values[best % x.values.length], page.map.data.y.values[Math.floor(best / x.values.length)]];
}
