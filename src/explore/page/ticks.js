// Numbers as text, ranges of values, and round values along an axis.

const RAISED = Object.fromEntries([..."0123456789-"].map((it, i) => [it, "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"[i]]));
const raised = (power) => [...String(power)].map((it) => RAISED[it]).join("");
const signed = (text) => text.replace("-", "−");

/** A number with `digits` significant digits at most. */
export function short(value, digits = 6) {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : value < 0 ? "−∞" : "no value";
  const [size, rounded] = [Math.abs(value), Number(value.toPrecision(digits))];
  if (rounded === 0 || (size >= 1e-4 && size < 1e6)) return signed(String(rounded));
  const [head, power] = rounded.toExponential().split("e");
  return signed(`${head}×10${raised(Number(power))}`);
}

/** What rounding leaves of a result that is zero, by the unit shown, as in the figures. */
const NOISE = {
  "m/s": 1e-10, "cm/s": 1e-8, "mm/s": 1e-7, "µm/s": 1e-4, m: 1e-12, cm: 1e-10, mm: 1e-9, "µm": 1e-6, in: 4e-11,
  J: 1e-12, mJ: 1e-9, "µJ": 1e-6, N: 1e-10, mN: 1e-7, kN: 1e-13,
};

/** A result in the unit shown: "≈ 0" where it is what rounding leaves of zero, a dash where there is none. */
export function result(value, unit, digits = 5) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  return Math.abs(value) < NOISE[unit] ? "≈ 0" : short(value, digits);
}

/** The ends of some values with a margin; others where all are the same. */
export function range(values, margin = 0.05) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (Number.isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
  }
  if (low > high) return [0, 1];
  const room = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? margin * (high - low) : Math.abs(low) * 0.1 || 1;
  return [low - room, high + room];
}

// The text of values that lie a step apart and are no larger than `top`; all of an axis are written alike.
function format(step, top) {
  const power = Math.floor(Math.log10(top) + 1e-9), isFar = top >= 1e5 || top < 1e-3;
  const digits = Math.max(0, (isFar ? power : 0) - Math.floor(Math.log10(step) + 1e-9));
  if (!isFar) return (value) => signed(value.toFixed(digits).replace(/^-(?=[0.]*$)/, ""));
  const zero = step / 1e6;
  return (value) => (Math.abs(value) < zero ? "0" : signed(`${(value / 10 ** power).toFixed(digits)}×10${raised(power)}`));
}

/** The texts of values along an axis. Where they do not all fit, they are counted from the round number `offset`, in units of `unit`,
 * which the label of the axis has to say; both are none where the texts are the values. */
export function texts({ values, text }, fits) {
  const plain = values.map((it) => text(it));
  const step = values[1] - values[0], isEven = values.length > 1 && Math.abs(values.at(-1) - values[0] - step * (values.length - 1)) < step / 2;
  if (!isEven || plain.every(fits)) return { texts: plain, offset: 0, unit: "" };
  const whole = 10 ** Math.ceil(Math.log10(step * values.length) - 1e-9);
  const isOneSided = values[0] > 0 || values.at(-1) < 0, least = values[0] > 0 ? values[0] : values.at(-1);
  const offset = isOneSided ? Number((Math.trunc(least / whole + 1e-9 * Math.sign(least)) * whole).toPrecision(12)) : 0;
  const near = values.map((it) => it - offset), power = Math.floor(Math.log10(step) + 1e-9);
  const isFar = power < -3 || power > 3, unit = isFar ? 10 ** power : 1, short = format(step / unit, Math.max(1, ...near.map((it) => Math.abs(it / unit))));
  return { texts: near.map((it) => short(it / unit)), offset, unit: isFar ? `10${raised(power)}` : "" };
}

function even(low, high, about) {
  const most = Math.max(Math.floor(about), 2), rough = (high - low) / most;
  if (!(rough > 0)) return { values: [low], text: short };
  const power = Math.floor(Math.log10(rough) + 1e-9) - 1;
  const first = (step) => Math.ceil(low / step - 1e-9), count = (step) => Math.floor(high / step + 1e-9) - first(step) + 1;
  const step = [1, 2, 5, 10, 20, 50, 100, 200].map((it) => it * 10 ** power).find((it) => count(it) <= most);
  const values = Array.from({ length: count(step) }, (_, i) => (first(step) + i) * step);
  return { values, text: format(step, Math.max(...values.map(Math.abs), step)) };
}

// A round value by its power of ten.
function power(value) {
  if (value === 0) return "0";
  const size = Math.abs(value), exponent = Math.floor(Math.log10(size) + 1e-9), digit = Math.round(size / 10 ** exponent);
  return `${value < 0 ? "−" : ""}${digit === 1 ? "" : `${digit}×`}10${raised(exponent)}`;
}

/** The text of round values over decades: all are written alike. */
export const alike = (values) => (values.every((it) => it === 0 || (Math.abs(it) >= 1e-3 && Math.abs(it) <= 1e4)) ? (it) => short(it) : power);

function decades(low, high, most) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
  const stride = Math.max(1, Math.ceil((last - first + 1) / Math.max(most, 2)));
  const powers = Array.from({ length: Math.max(last - first + 1, 0) }, (_, i) => first + i).filter((it) => (it - first) % stride === 0);
  const parts = Array.from({ length: last - first + 3 }, (_, i) => [1, 2, 5].map((digit) => digit * 10 ** (first - 1 + i))).flat();
  const values = parts.filter((it) => it >= low * (1 - 1e-9) && it <= high * (1 + 1e-9));
  const isMany = !(values.length > 2 && values.length <= most + 1);
  if (isMany && powers.length < 2) return even(low, high, most);
  const all = isMany ? powers.map((it) => 10 ** it) : values;
  return { values: all, text: alike(all) };
}

/** Round values between two, at most about `most`, and the text of each. */
export function ticks(low, high, isLogarithmic = false, most = 6) {
  return isLogarithmic && low > 0 ? decades(low, high, most) : even(low, high, most);
}
