// The sentences about a row that is played: its moves, the position of its ghost frame, and what the row misses.

import { column } from "../motion.js";
import { isClosed, missText, short } from "../frames/gap.js";
import { worded } from "../../shared/words/words.js";

const LOWERED = "₀₁₂₃₄₅₆₇₈₉";
/** @type {Record<string, string>} */
const LETTERS = { a: "a", alpha: "α", d: "d", theta: "θ" };
const SMALL = 1e-9;

/** @param {number} number */
export const lowered = (number) => [...String(number)].map((digit) => LOWERED[Number(digit)]).join("");

/**
 * Return a move in words, such as "along x₂ by a₂ = 0.5 m". The row leads from frame {row − 1} to frame {row}.
 *
 * @param {Front.Move} move
 * @param {number} row
 * @param {Api.Convention} convention
 * @param {string} unit of lengths
 */
export function moveText(move, row, convention, unit) {
  const values = { axis: axisOf(move, row, convention), amount: amountText(move, row, convention, unit) };
  return move.turns ? worded("turn about {axis} by {amount}", values) : worded("along {axis} by {amount}", values);
}

/** Return a move's axis, such as x₂. @param {Front.Move} move @param {number} row @param {Api.Convention} convention */
function axisOf({ axis }, row, convention) {
  // In the standard convention, the moves along and about x come last; in the modified one, they come first.
  return `${axis}${lowered((axis === "x") === (convention === "modified") ? row - 1 : row)}`;
}

/** @param {Front.Move} move @param {number} row @param {Api.Convention} convention @param {string} unit */
export function amountText({ parameter, turns, amount }, row, convention, unit) {
  const isBefore = convention === "modified" && (parameter === "a" || parameter === "alpha");
  const name = `${LETTERS[parameter]}${lowered(isBefore ? row - 1 : row)}`;
  const written = turns ? `${short(Math.round((amount * 1800) / Math.PI) / 10)}°` : `${short(amount)} ${unit}`;
  return `${name} = ${written.replace("-", "−")}`;
}

/**
 * Return the caption of a row after `at` moves.
 *
 * @param {{ row: number, at: number, moves: Front.Move[], convention: Api.Convention, unit: string }} shown
 */
export function captionText({ row, at, moves, convention, unit }) {
  if (at < SMALL) return worded("Row {row} begins on frame {frame}.", { row, frame: `{${row - 1}}` });
  const i = Math.ceil(at - SMALL) - 1;
  const values = { number: i + 1, all: moves.length, move: moveText(moves[i], row, convention, unit) };
  return Math.abs(moves[i].amount) < SMALL
    ? worded("{number} of {all}: {move}, so nothing moves.", values)
    : worded("{number} of {all}: {move}.", values);
}

/**
 * Return the caption of a row after `at` moves, without the amount of the move.
 *
 * @param {{ row: number, at: number, moves: Front.Move[], convention: Api.Convention }} shown
 */
export function captionWithoutAmount({ row, at, moves, convention }) {
  const i = Math.ceil(at - SMALL) - 1;
  const values = { number: i + 1, all: moves.length, axis: axisOf(moves[i], row, convention) };
  return moves[i].turns
    ? worded("{number} of {all}: turn about {axis}.", values)
    : worded("{number} of {all}: along {axis}.", values);
}

/**
 * Return a sentence that says where the ghost frame is.
 *
 * @param {Front.Frame} frame
 */
export const placeText = (frame) =>
  worded("The ghost frame is at {point}.", { point: `(${column(frame, 3).map(short).join(", ")})` });

/**
 * Return a sentence that says if frame {row} lies on the axis of a joint.
 *
 * @param {number} row
 * @param {number} joint
 * @param {Front.Gap} gap
 * @param {string} unit
 */
export function axisText(row, joint, gap, unit) {
  const z = `z${lowered(row)}`;
  if (isClosed(gap)) return worded("{axis} lies on the axis of joint {joint}.", { axis: z, joint });
  return worded("{axis} misses the axis of joint {joint}: {gap}.", { axis: z, joint, gap: missText(gap, unit) });
}
