// Colours of numbers by the names of the command line, whose figures have the same.

/** Colours between which a ramp is straight. */
const TABLES = {
  "viridis": "440154481769472a7a433d843d4e8a355e8d2e6d8e297b8e23898e1f978b21a5852eb37c46c06f65cb5e89d548b0dd2fd8e219fde725",
  "magma": "0000040907201a10423111654a1079621980792282912b81aa337dc23b75d9466bec5860f7725cfc8e64feaa74fec68afde2a3fcfdbf",
  "inferno": "0000040a07221e0c45380962510e6c69166e801f6c982766b0315bc63d4dd94d3de9612bf47918fa9407fcb014f8cd37f2ea69fcffa4",
  "plasma": "0d08872f05964903a06100a77801a88e0ca4a21d9ab42e8dc43e7fd24f71de6164e97257f3854bf99a3efdaf31fdc627f8df25f0f921",
};
/** Colours along which a ramp is a cubic spline. */
const SPLINES = {
  "greys": "fffffff0f0f0d9d9d9bdbdbd969696737373525252252525000000",
  "blues": "f7fbffdeebf7c6dbef9ecae16baed64292c62171b508519c08306b",
  "blue-red": "0530612166ac4393c392c5ded1e5f0f7f7f7fddbc7f4a582d6604db2182b67001f",
  "purple-orange": "2d004b5427888073acb2abd2d8daebf7f7f7fee0b6fdb863e08214b358067f3b08",
  "green-brown": "003c3001665e35978f80cdc1c7eae5f5f5f5f6e8c3dfc27dbf812d8c510a543005",
};
/** Polynomials of red, green and blue, from the constant on. */
const POLYNOMIALS = {
  "cividis": [[-4.54, -35.34, 2381.73, -6402.7, 7024.72, -2710.57], [32.49, 170.73, 52.82, -131.46, 176.58, -67.37], [81.24, 442.36, -2482.43, 6167.24, -6614.94, 2475.67]],
  "turbo": [[34.61, 1172.33, -10793.56, 33300.12, -38394.49, 14825.05], [23.31, 557.33, 1225.33, -3574.96, 1073.77, 707.56], [27.2, 3211.1, -15327.97, 27814, -22569.18, 6838.66]],
};
/** The names of all, those for numbers of one sign first. */
export const NAMES = ["viridis", "cividis", "magma", "inferno", "plasma", "greys", "blues", "turbo", "blue-red", "purple-orange", "green-brown"];

const colours = (text) => text.match(/.{6}/g).map((it) => [0, 2, 4].map((at) => parseInt(it.slice(at, at + 2), 16)));
const limited = (value) => Math.min(Math.max(Math.trunc(value), 0), 255);

function straight(all, share) {
  const at = Math.min(Math.floor(share * (all.length - 1)), all.length - 2), part = share * (all.length - 1) - at;
  return [0, 1, 2].map((i) => Math.round(all[at][i] + part * (all[at + 1][i] - all[at][i])));
}

// A uniform cubic spline; its ends lie on the first and the last colour.
function spline(all, share) {
  const last = all.length - 1, at = Math.min(Math.floor(share * last), last - 1), t = share * last - at;
  return [0, 1, 2].map((i) => {
    const b = all[at][i], c = all[at + 1][i], a = at ? all[at - 1][i] : 2 * b - c, d = at < last - 1 ? all[at + 2][i] : 2 * c - b;
    return limited(((1 - t) ** 3 * a + (4 - 6 * t * t + 3 * t ** 3) * b + (1 + 3 * t + 3 * t * t - 3 * t ** 3) * c + t ** 3 * d) / 6);
  });
}

const polynomial = (all, share) => all.map((of) => limited(of.reduce((sum, it, power) => sum + it * share ** power, 0)));

/** The ramp of a name: red, green and blue at a share of it. */
export function ramp(name) {
  if (POLYNOMIALS[name]) return (share) => polynomial(POLYNOMIALS[name], share);
  const all = colours(TABLES[name] || SPLINES[name]), between = TABLES[name] ? straight : spline;
  return (share) => between(all, share);
}
