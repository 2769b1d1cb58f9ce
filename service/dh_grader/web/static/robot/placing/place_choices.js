// The places for an origin, and the directions for x, of a robot with all joint variables 0.
//
// A line is `[point, unit vector]`. The first lines are the joint axes, then the z axes of the given frames. The code
// does not know which choice is correct: it offers every place for every frame.

const CLOSE = 1e-6;
// The possible factors of a symbol in a coordinate.
const FACTORS = [0, 1, -1];
const MOST_SYMBOLS = 7;
const BASE = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/** @param {number[]} a @param {number[]} b */
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
/** @param {number[]} a @param {number[]} b */
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
/** @param {number[]} a @param {number[]} b @param {number} [share] */
export const along = (a, b, share = 1) => a.map((value, i) => value + share * b[i]);
/** @param {number[]} a @param {number[]} b */
export const isSame = (a, b) => a.length === b.length && a.every((value, i) => Math.abs(value - b[i]) < CLOSE);

/**
 * Return the named points of line `i`: given points, crossings and the feet of common perpendiculars.
 *
 * @param {number[][][]} lines
 * @param {number} i
 */
export function namedPoints(lines, i) {
  const [point, axis] = lines[i];
  return lines.map(([other, direction]) => {
    const between = along(other, point, -1);
    const turn = dot(axis, direction);
    const square = 1 - turn * turn;
    const [own, others] = [dot(between, axis), dot(between, direction)];
    // Parallel axes have many common perpendiculars. Take the perpendicular through the given point of the other axis.
    return along(point, axis, square < CLOSE ? own : (own - turn * others) / square);
  });
}

/**
 * Return unit vectors along the axes of the base and the common perpendiculars of line `i`, and their opposites.
 *
 * @param {number[][][]} lines
 * @param {number} i
 */
export function xDirections(lines, i) {
  const [point, axis] = lines[i];
  const normals = lines.map(([other, direction]) => {
    const normal = cross(axis, direction);
    const between = along(other, point, -1);
    return dot(normal, normal) > CLOSE ? normal : along(between, axis, -dot(between, axis));
  });
  /** @type {number[][]} */
  const found = [];
  for (const each of [...BASE, ...normals]) {
    const length = Math.sqrt(dot(each, each));
    if (length < CLOSE) continue;
    for (const sign of [1, -1]) {
      const unit = each.map((value) => (sign * value) / length);
      if (!found.some((other) => isSame(other, unit))) found.push(unit);
    }
  }
  return found;
}

/**
 * Return factors for symbols so that their sum is a length; null if there are none. The symbols' values must have no
 * simple relation.
 *
 * @param {number} length
 * @param {number[]} values
 */
export function sumOf(length, values) {
  const used = values.slice(0, MOST_SYMBOLS);
  for (let code = 0; code < FACTORS.length ** used.length; code++) {
    const factors = used.map((_, i) => FACTORS[Math.floor(code / FACTORS.length ** i) % FACTORS.length]);
    if (Math.abs(dot(factors, used) - length) < CLOSE) return factors;
  }
  return null;
}

/**
 * Return a sum of symbols as a text, such as "l1 + l2".
 *
 * @param {number[]} factors
 * @param {string[]} names
 */
export function sumText(factors, names) {
  const terms = factors.flatMap((factor, i) => (factor ? [`${factor > 0 ? "+" : "-"} ${names[i]}`] : []));
  return terms.join(" ").replace(/^\+ /, "").replace(/^- /, "-") || "0";
}
