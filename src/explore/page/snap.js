// Lines that lie along an axis, and whether they cross a part of the plane.

/** Below this angle to an axis a line lies along it. */
const ANGLE = 3 * Math.PI / 180;

/** The end `to` of a line, moved so that it lies along an axis where it nearly does or must; `place` gives places on the canvas. */
export function along(from, to, place, isForced) {
  const [begin, end] = [place(from), place(to)];
  const angle = Math.atan2(Math.abs(end[1] - begin[1]), Math.abs(end[0] - begin[0]));
  if (angle < (isForced ? Math.PI / 4 : ANGLE)) return [to[0], from[1]];
  if (isForced || angle > Math.PI / 2 - ANGLE) return [from[0], to[1]];
  return to;
}

/** Whether a line has a point in a part of the plane: it is cut at both ends of each axis in turn. */
export function crosses(from, to, part) {
  let [begins, ends] = [0, 1];
  return part.every(([low, high], axis) => {
    const length = to[axis] - from[axis];
    if (length === 0) return from[axis] >= low && from[axis] <= high;
    const [a, b] = [(low - from[axis]) / length, (high - from[axis]) / length];
    [begins, ends] = [Math.max(begins, Math.min(a, b)), Math.min(ends, Math.max(a, b))];
    return begins <= ends;
  });
}
