// The words of a row that is played: its moves, where its ghost is, and what it misses.

import { column } from "../motion.js";
import { gapText, isClosed, short } from "../frames/gap.js";

const LOWERED = "₀₁₂₃₄₅₆₇₈₉";
/** @type {Record<string, string>} */
const LETTERS = { a: "a", alpha: "α", d: "d", theta: "θ" };
const SMALL = 1e-9;

/** @param {number} number */
export const lowered = (number) => [...String(number)].map((digit) => LOWERED[Number(digit)]).join("");

/**
 * Return what a move is, such as "along x₂ by a₂ = 0.5 m". The row leads from frame {row − 1} to frame {row}.
 *
 * @param {Front.Move} move
 * @param {number} row
 * @param {Api.Convention} convention
 * @param {string} unit of lengths
 */
export function moveText(move, row, convention, unit) {
  const isModified = convention === "modified";
  // In the standard convention, the moves along and about x come last; in the modified one, they come first.
  const axis = (move.axis === "x") === isModified ? row - 1 : row;
  const about = `${move.turns ? "turn about" : "along"} ${move.axis}${lowered(axis)}`;
  return `${about} by ${amountText(move, row, convention, unit)}`;
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
  if (at < SMALL) return `Row ${row} begins on frame {${row - 1}}.`;
  const i = Math.ceil(at - SMALL) - 1;
  const text = moveText(moves[i], row, convention, unit);
  const still = Math.abs(moves[i].amount) < SMALL ? ", so nothing moves" : "";
  return `${i + 1} of ${moves.length}: ${text}${still}.`;
}

/**
 * Say where a ghost is.
 *
 * @param {Front.Frame} frame
 */
export const placeText = (frame) => `The ghost frame is at (${column(frame, 3).map(short).join(", ")}).`;

/**
 * Say whether frame {row} lies on the axis of a joint.
 *
 * @param {number} row
 * @param {number} joint
 * @param {Front.Gap} gap
 */
export function axisText(row, joint, gap) {
  const z = `z${lowered(row)}`;
  if (isClosed(gap)) return `${z} lies on the axis of joint ${joint}.`;
  return `${z} misses the axis of joint ${joint}: ${gapText(gap)}.`;
}
