// The four moves of a row, in the order of the convention, and a frame on its way through them.

/** The columns of a table in the order of the service. */
export const COLUMNS = ["a", "alpha", "d", "theta"];

/** @type {Record<string, Pick<Move, "axis" | "turns">>} */
const KINDS = {
  a: { axis: "x", turns: false },
  alpha: { axis: "x", turns: true },
  d: { axis: "z", turns: false },
  theta: { axis: "z", turns: true },
};
const ORDER = {
  standard: ["theta", "d", "a", "alpha"],
  modified: ["alpha", "a", "theta", "d"],
};

/**
 * A move turns about an axis of the moving frame by an angle in radians, or goes along the axis by a length.
 *
 * @typedef {{ parameter: string, axis: "x" | "z", turns: boolean, amount: number }} Move
 */

/**
 * Return the four moves of a row with these numbers.
 *
 * @param {number[]} values a, alpha, d and theta
 * @param {Api.Convention} convention
 * @returns {Move[]}
 */
export function movesOf(values, convention) {
  return ORDER[convention].map((parameter) => ({
    parameter,
    ...KINDS[parameter],
    amount: values[COLUMNS.indexOf(parameter)],
  }));
}

/**
 * Return the frame after `at` moves: 2.5 is the middle of the third move.
 *
 * @param {Front.Frame} frame
 * @param {Move[]} moves
 * @param {number} at
 * @returns {Front.Frame}
 */
export function frameAt(frame, moves, at) {
  return moves.reduce((moving, move, i) => moved(moving, move, Math.max(0, Math.min(1, at - i))), frame);
}

/**
 * Return the frame after a share of a move.
 *
 * @param {Front.Frame} frame
 * @param {Move} move
 * @param {number} share
 * @returns {Front.Frame}
 */
function moved(frame, { axis, turns, amount }, share) {
  const by = share * amount;
  const along = axis === "z" ? 2 : 0;
  if (!turns) return frame.map((row) => [...row.slice(0, 3), row[3] + by * row[along]]);
  // A turn about z takes x towards y, a turn about x takes y towards z.
  const [from, to] = axis === "z" ? [0, 1] : [1, 2];
  const [cosine, sine] = [Math.cos(by), Math.sin(by)];
  return frame.map((row) =>
    row.with(from, cosine * row[from] + sine * row[to]).with(to, cosine * row[to] - sine * row[from])
  );
}
