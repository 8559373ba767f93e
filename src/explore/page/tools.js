// The tools of the page: those of the map, undo and redo, and the part of the map that is seen.

import * as colouring from "./colouring.js";
import * as view from "./view.js";
import { isBasin } from "./attractors.js";
import { by } from "./element.js";
import { handMaps, nameSaving, saveMap } from "./handed.js";
import { legend } from "./legend.js";
import { page } from "./shown.js";
import { prices } from "./tradeoff.js";

/** Calls `act` where a button is pressed. */
export const pressed = (id, act) => by(id).addEventListener("click", act);

/** Holds a switch in the address. */
export const switched = (name) => by(`${name}-switch`).addEventListener("change", (event) => view.step({ [name]: event.target.checked ? 1 : null }));

const written = (window) => window && window.flat().map((it) => Number(it.toFixed(5))).join(",");

/** Whether the map shows the part that the address names. */
export const isSeen = () => (view.text("window") ?? null) === written(page.map.window);

/** Shows the part of the map that the address names. */
export function look() {
  const all = view.numbers("window", 4);
  if (all) page.map.look(all.slice(0, 2), all.slice(2)); else page.map.look();
}

// What depends on the part of the map that is seen.
function seen() {
  legend();
  nameSaving();
  handMaps();
}

let looking = 0;
/** Many parts are seen while the map is dragged: the last one is held. */
export function looked(window) {
  clearTimeout(looking);
  looking = setTimeout(() => {
    if ((view.text("window") ?? null) !== written(window)) view.settle({ window: written(window) });
    if (page.map.data) seen();
  }, 200);
}

/** Listens to the tools of the map. */
export function listenToMap() {
  const { map, file } = page, turn = (kind) => () => map.setMode(map.mode === kind ? "move" : kind);
  pressed("line-button", turn("line"));
  pressed("brush-button", turn("rectangle"));
  pressed("in-button", () => map.zoom(0.8));
  pressed("out-button", () => map.zoom(1.25));
  pressed("whole-button", () => map.look());
  for (const format of ["pdf", "svg"]) pressed(`${format}-button`, (event) => saveMap(format, event.currentTarget));
  switched("exact");
  by("brush-button").hidden = !prices(file).length;
  if (isBasin(file)) {
    // They are what such a file is about, and are shown unless they are taken away.
    by("curves-switch").parentElement.title = "Attractors, saddles and manifolds of the file";
    by("curves-switch").addEventListener("change", ({ target }) => view.step({ bare: target.checked ? null : 1 }));
  } else {
    switched("curves");
    by("curves-switch").parentElement.hidden = !file.has_curves;
  }
  colouring.listen();
}

const isWriting = ({ target }) => /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName) && !["checkbox", "range"].includes(target.type);

/** Listens to undo and redo, by buttons and keys. */
export function listenToSteps() {
  pressed("undo-button", () => view.go(-1));
  pressed("redo-button", () => view.go(1));
  addEventListener("keydown", (event) => {
    if (event.key.toLowerCase() !== "z" || !(event.ctrlKey || event.metaKey) || event.altKey || isWriting(event)) return;
    event.preventDefault();
    view.go(event.shiftKey ? 1 : -1);
  });
}

/** Tells which steps there are. */
export function offerSteps() {
  const [undo, redo] = view.undoable();
  [by("undo-button").disabled, by("redo-button").disabled] = [!undo, !redo];
}

