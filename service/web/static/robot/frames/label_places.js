// Places of the labels in the 3D view: no two of them overlap.

const APART = 2;
// The place of a label's own point in it, as shares of its size from its lower left corner. The first is preferred.
/** @type {[number, number][]} */
const AROUND = [
  [0, 0],
  [0, -0.9],
  [0, 0.9],
  [-0.8, 0],
  [0.8, 0],
  [-0.8, -0.9],
  [0.8, -0.9],
  [-0.8, 0.9],
  [0.8, 0.9],
  [0, -1.8],
  [0, 1.8],
  [-1.6, 0],
  [1.6, 0],
  [-1.6, -1.8],
  [1.6, -1.8],
  [-1.6, 1.8],
  [1.6, 1.8],
]; // deno-fmt-ignore

/** @typedef {{ left: number, right: number, low: number, high: number }} Room */

/**
 * Return the free place nearest to the preferred one, and take it; or null if there is none.
 *
 * `x` and `y` are the label's point in pixels, `centre` its preferred place in the label.
 *
 * @param {{ x: number, y: number, width: number, height: number, centre: [number, number] }} label
 * @param {Room[]} taken
 * @returns {[number, number] | null}
 */
export function takePlace({ x, y, width, height, centre: [across, up] }, taken) {
  for (const [right, top] of AROUND) {
    /** @type {[number, number]} */
    const centre = [across + right, up + top];
    const left = x - centre[0] * width;
    const low = y - centre[1] * height;
    const room = { left, right: left + width, low, high: low + height };
    if (!taken.some((other) => overlap(room, other))) {
      taken.push(room);
      return centre;
    }
  }
  return null;
}

/** @param {Room} one @param {Room} other */
function overlap(one, other) {
  return one.left < other.right + APART && other.left < one.right + APART &&
    one.low < other.high + APART && other.low < one.high + APART;
}
