// Places of the labels in the 3D view: no two of them overlap.

const APART = 2;
// Places for a label around its point: shifts from the preferred place, as shares of the label's size.
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
 * Return the free place that is nearest to the preferred place, and take it; null if no place is free.
 *
 * A place says where the label's point is within the label, as shares of its size from its lower left corner. `x` and
 * `y` are the label's point in pixels, `centre` is the preferred place.
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
