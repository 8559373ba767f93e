// Branches of periodic orbits, stable or not, through the motions of a line, drawn under its points.

import * as ask from "./ask.js";
import * as curves from "./curves.js";
import * as busy from "./busy.js";
import { button, by, element, folded, say, table } from "./element.js";
import { entry } from "./marks.js";
import { model, shown } from "./model.js";
import { colours } from "./plot.js";
import { range, short } from "./ticks.js";

/** Branches that are followed for one line at most. */
const MOST = 12;
/** A motion lies on a branch that passes it so near, relative to what the line shows: between two orbits a branch is taken for straight. */
const NEAR = 0.01;

/** The branches of one line; `redraw` is called where they change. */
export class Branches {
  constructor(redraw) {
    Object.assign(this, { redraw, all: [], running: null, line: null });
    this.button = button("Follow branches", () => this.follow(), { id: "branches-button", hidden: true });
    this.told = element("p", { id: "branches-told", className: "note" });
    this.values = element("div");
    by("branches-place").append(this.values);
  }

  /** Forgets the branches of a line that is no longer shown. */
  clear() {
    this.running?.abort();
    Object.assign(this, { all: [], running: null, line: null });
    this.button.hidden = true;
    this.told.textContent = "";
    this.values.replaceChildren();
    by("branches-empty").hidden = !by("curves-place").hidden;
  }

  /** Offers to follow the branches of a line that is computed: `points` are its values, `pairs` what was asked of the server. */
  offer(line) {
    Object.assign(this, { all: [], line });
    this.button.hidden = !line.points.some((it) => it.period);
  }

  async follow() {
    const { line } = this, running = new AbortController();
    Object.assign(this, { running, all: [] });
    this.button.hidden = true;
    const lost = new Set(), began = performance.now(), task = busy.begin("branches", "Branches");
    let asked = 0, why = "";
    try {
      for (; asked < MOST; asked++) {
        const place = line.points.findIndex((it, i) => it.period && it.end && !lost.has(i) && !this.isOnBranch(it));
        if (place < 0) break;
        this.told.textContent = `Following branch ${asked + 1}.`;
        task.tell(`branch ${asked + 1}`, asked / MOST);
        const { end, period } = line.points[place];
        const orbit = Object.fromEntries(end.map((value, i) => [`orbit_${model.starts[i].name}`, value]));
        await ask.lines("/api/branches", { ...line.pairs, ...orbit, period, place }, (it) => {
          this.all.push(...(it.branches || []));
          why = it.why || why;
        }, running.signal);
        // A motion beside which none was found is not asked for again.
        if (!this.isOnBranch(line.points[place])) lost.add(place);
        this.redraw();
      }
      task.end();
      this.tell(((performance.now() - began) / 1e3).toFixed(1), why);
    } catch (it) {
      task.end(false);
      if (it.name === "AbortError") return;
      this.told.textContent = `Branches: ${it.message}`;
      this.button.hidden = false;
      say(this.told.textContent);
    }
  }

  // What was followed, and which motions lie on none of it.
  tell(seconds, why) {
    const { line, all } = this, periodic = line.points.filter((it) => it.period);
    const apart = periodic.filter((it) => !this.isOnBranch(it)).length, special = all.flatMap((it) => it.special);
    const points = all.reduce((sum, it) => sum + it.points.length, 0), several = (count, word) => `${count} ${word}${count === 1 ? "" : word.endsWith("ch") ? "es" : "s"}`;
    const parts = [`${several(all.length, "branch")} of ${several(points, "orbit")} in ${seconds} s`];
    if (apart) parts.push(`${apart} of ${periodic.length} periodic motions lie on none of them${why ? ` (${why})` : all.length >= MOST ? ` (${MOST} are followed at most)` : ""}`);
    this.told.textContent = `${parts.join("; ")}.`;
    say(this.told.textContent);
    const { main_output: main, section: [first] } = model, at = (it) => line.place(it.share);
    const rows = () => special.map((it) => [it.words, line.value(at(it)), short(it[first.name][0] * first.factor, 6), shown(it[main.name], main)]);
    const end = (it) => line.value(at(it)), part = (points) => points.filter((it) => it.stable).length;
    const branches = all.map((it, i) => [`branch ${i + 1}`, String(it.period), end(it.points[0]), end(it.points.at(-1)), String(it.points.length), `${short(100 * part(it.points) / it.points.length, 3)} %`]);
    this.values.replaceChildren(element("p", { textContent: this.told.textContent }), ...(all.length ? [table("Branches", ["branch", "period", `from, ${line.label}`, `to, ${line.label}`, "orbits", "stable"], branches)] : []));
    by("branches-empty").hidden = true;
    if (special.length) this.values.append(folded(`Special points (${special.length})`, ["point", line.label, first.label, main.label], rows, true));
    this.redraw();
  }

  // Whether a motion of the line lies on the stable part of a branch.
  isOnBranch(it) {
    const { main_output: main, section: [first] } = model, { points } = this.line;
    const span = (name) => { const [low, high] = range(points.flatMap((other) => other[name] ?? []).filter(Number.isFinite), 0); return high - low || Math.abs(high) || 1; };
    const least = (other) => Math.min(...other[first.name]);
    const parts = [[(other) => other[main.name], span(main.name)], [least, span(first.name)]];
    return this.all.filter((branch) => branch.period === it.period).some((branch) => branch.points.some((to, i) => {
      const from = branch.points[i - 1];
      if (!from || !(from.stable || to.stable) || (it.share - from.share) * (it.share - to.share) > 0) return false;
      const part = to.share === from.share ? 0 : (it.share - from.share) / (to.share - from.share);
      return parts.every(([of, width]) => Math.abs(of(from) + part * (of(to) - of(from)) - of(it)) <= NEAR * width);
    }));
  }

  /** The values of all branches, for the ranges of a diagram: of the section and of the main output, in SI. */
  ranges() {
    const { main_output: main, section: [first] } = model, points = this.all.flatMap((it) => it.points);
    return [points.flatMap((it) => it[first.name]), points.map((it) => it[main.name])];
  }

  /** Draws them: `upper` and `lower` place the section and the main output, and `at` has the abscissa of a share. */
  draw(drawn, upper, lower, at) {
    const { main_output: main, section: [first] } = model;
    for (const branch of this.all) {
      for (let cycle = 0; cycle < branch.period; cycle++) this.path(drawn, branch.points, (it) => [upper.x(at(it.share)), upper.y(it[first.name][cycle] * first.factor)]);
      this.path(drawn, branch.points, (it) => [lower.x(at(it.share)), lower.y(it[main.name] * main.factor)]);
    }
    for (const it of this.all.flatMap((branch) => branch.special)) {
      for (const value of it[first.name]) curves.point(drawn, [upper.x(at(it.share)), upper.y(value * first.factor)], it, 4);
      curves.point(drawn, [lower.x(at(it.share)), lower.y(it[main.name] * main.factor)], it, 4);
    }
  }

  // A line through the places of orbits, broken where these are not stable.
  path(drawn, points, place) {
    drawn.strokeStyle = colours().ink;
    for (const [isStable, dashes, width] of [[true, [], 1.2], [false, [4, 3], 0.9]]) {
      drawn.setLineDash(dashes);
      drawn.lineWidth = width;
      drawn.beginPath();
      points.forEach((it, i) => {
        if (!i || points[i - 1].stable !== isStable) drawn.moveTo(...place(it));
        else drawn.lineTo(...place(it));
      });
      drawn.stroke();
    }
    drawn.setLineDash([]);
  }

  /** The entries of the legend of the diagram. */
  entries() {
    const stroke = (dashes, width) => (drawn, [x, y]) => {
      drawn.setLineDash(dashes);
      [drawn.strokeStyle, drawn.lineWidth] = [colours().ink, width];
      drawn.beginPath(); drawn.moveTo(x - 12, y); drawn.lineTo(x + 12, y); drawn.stroke();
      drawn.setLineDash([]);
    };
    const has = (isStable) => this.all.some((branch) => branch.points.some((it) => it.stable === isStable));
    const kinds = [...new Map(this.all.flatMap((it) => it.special).map((it) => [it.words, it])).values()];
    return [
      ...(has(true) ? [entry("stable orbits", stroke([], 1.5))] : []),
      ...(has(false) ? [entry("unstable orbits", stroke([4, 3], 1.2))] : []),
      ...kinds.map((it) => entry(it.words, (drawn, at) => curves.point(drawn, at, it))),
    ];
  }
}
