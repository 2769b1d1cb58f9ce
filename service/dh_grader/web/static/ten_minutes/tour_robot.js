// The arm of "DH in ten minutes": a column and two links, its frames, and the row of its table for each screen.

import { frameAt, movesOf } from "../robot/rows/row_moves.js";

const [H, W, R] = [0.5, 0.45, 0.52];
const QUARTER = Math.PI / 2;
const [Q1, Q2] = [QUARTER / 3, QUARTER / 2];

/** The frame on the floor. @type {Front.Frame} */
const FLOOR = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]];

/**
 * The exercise that grades the answers, the labels of its rows, and the rows (a, alpha, d, theta) as texts and numbers.
 *
 * @type {Record<Api.Convention, { exercise: string, labels: string[], texts: string[][], values: number[][] }>}
 */
export const ARM = {
  standard: {
    exercise: "first-arm",
    labels: ["1", "2"],
    texts: [["w", "90", "h", "q1"], ["r", "0", "0", "q2"]],
    values: [[W, QUARTER, H, Q1], [R, 0, 0, Q2]],
  },
  modified: {
    exercise: "first-arm-modified",
    labels: ["1", "2", "e"],
    texts: [["0", "0", "h", "q1"], ["w", "90", "0", "q2"], ["r", "0", "0", "0"]],
    values: [[0, 0, H, Q1], [W, QUARTER, 0, Q2], [R, 0, 0, 0]],
  },
};

/** The index (from 0) of the row that each screen is about. @type {Record<string, Record<Api.Convention, number>>} */
export const ROWS = {
  theta: { standard: 0, modified: 0 },
  d: { standard: 0, modified: 0 },
  a: { standard: 0, modified: 1 },
  alpha: { standard: 0, modified: 1 },
  table: { standard: 1, modified: 2 },
};

/** @param {Api.Convention} convention @param {number} row */
export const moves = (convention, row) => movesOf(ARM[convention].values[row], convention);

/** Return all frames, from the floor to the tip. @param {Api.Convention} convention */
export function frames(convention) {
  /** @type {Front.Frame[]} */
  const found = [FLOOR];
  ARM[convention].values.forEach((_, i) => found.push(frameAt(found[i], moves(convention, i), 4)));
  return found;
}

/** The points of the arm: the foot and the top of the column, joint 2, and the tip. @returns {number[][]} */
export function corners() {
  const [, joint, tip] = frames("standard").map((frame) => frame.map((row) => row[3]));
  return [[0, 0, 0], [0, 0, H], joint, tip];
}

/** The two joint axes, each as a point and a direction. @returns {[number[], number[]][]} */
export function axes() {
  const [floor, joint] = frames("standard");
  return [[[0, 0, H], floor.map((row) => row[2])], [joint.map((row) => row[3]), joint.map((row) => row[2])]];
}
