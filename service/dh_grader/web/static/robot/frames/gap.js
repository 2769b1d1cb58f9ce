// The gap between the last frame of a student's table and the given tool frame.

import { column } from "../motion.js";
import { worded } from "../../shared/words/words.js";

const SMALL = 1e-6;

/**
 * Return a number with at most three decimals.
 *
 * @param {number} value
 */
export const short = (value) => String(Math.round(value * 1000) / 1000 + 0);

/**
 * A gap between frames: the origins, the distance between them, and the angle of rotation in degrees (`turn`).
 *
 * @typedef {{ from: number[], to: number[], length: number, turn: number }} Gap
 */

/**
 * Return the gap between two frames.
 *
 * @param {Front.Frame} one
 * @param {Front.Frame} other
 * @returns {Gap}
 */
export function gapBetween(one, other) {
  const [from, to] = [column(one, 3), column(other, 3)];
  const rows = [0, 1, 2];
  const trace = rows.reduce((sum, i) => sum + rows.reduce((part, j) => part + one[i][j] * other[i][j], 0), 0);
  const cosine = Math.max(-1, Math.min(1, (trace - 1) / 2));
  // The cosine is inexact near 0 degrees; the sine is exact there.
  const turned = rows.map((i) => rows.map((j) => rows.reduce((sum, k) => sum + one[k][i] * other[k][j], 0)));
  const sine = Math.hypot(turned[2][1] - turned[1][2], turned[0][2] - turned[2][0], turned[1][0] - turned[0][1]) / 2;
  return {
    from,
    to,
    length: Math.hypot(...to.map((value, i) => value - from[i])),
    turn: (Math.atan2(sine, cosine) * 180) / Math.PI,
  };
}

/** @param {Gap} gap */
export const isClosed = ({ length, turn }) => length < SMALL && turn < SMALL;

/**
 * Return the gap in a few words: 0.38, turned by 90°.
 *
 * @param {Gap} gap
 */
export function gapText({ length, turn }) {
  const values = { length: short(length), angle: `${short(Math.round(turn * 10) / 10)}°` };
  if (turn < SMALL) return length < SMALL ? "" : values.length;
  return length < SMALL ? worded("turned by {angle}", values) : worded("{length}, turned by {angle}", values);
}

/**
 * Return how a frame misses its goal, such as "0.38 m too low, turned by 90°", in directions of the base frame.
 *
 * @param {Gap} gap
 * @param {string} unit
 */
export function missText({ from, to, turn }, unit) {
  const sides = to.flatMap((value, i) => {
    const way = value - from[i];
    return Math.abs(way) < SMALL ? [] : [sideText(way > 0, i, `${short(Math.abs(way))} ${unit}`)];
  });
  const turned = turn < SMALL ? [] : [gapText({ from, to, length: 0, turn })];
  return [...sides, ...turned].join(", ");
}

/** @param {boolean} isShort @param {number} i @param {string} length */
function sideText(isShort, i, length) {
  if (i === 2) return isShort ? worded("{length} too low", { length }) : worded("{length} too high", { length });
  const values = { length, axis: `${"xy"[i]}₀` };
  return isShort ? worded("{length} short along {axis}", values) : worded("{length} too far along {axis}", values);
}
