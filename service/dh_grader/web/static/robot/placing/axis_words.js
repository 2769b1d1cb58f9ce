// The joint axes at a place of the stage, and the directions of axes as texts.

// The distances in pixels at which a click is on an axis, and at which two axes are one line.
const NEAR = 18;
const SAME = 3;
const ALONG = 0.999999;
const DIGITS = 6;

/**
 * Return the indices of the axes at a place, the nearest axis first; an empty list if all axes are far away.
 *
 * @param {number[]} at
 * @param {number[][][]} axes the two ends of each axis, in pixels
 */
export function nearestAxes(at, axes) {
  const far = axes.map((ends) => distance(at, ends));
  const least = Math.min(...far);
  const order = far.map((_, i) => i).sort((i, j) => far[i] - far[j]);
  return least > NEAR ? [] : order.filter((i) => far[i] <= least + SAME);
}

/** @param {number[]} at @param {number[][]} ends */
function distance([x, y], [[ax, ay], [bx, by]]) {
  const [dx, dy] = [bx - ax, by - ay];
  const square = dx * dx + dy * dy;
  const share = square ? Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
  return Math.hypot(x - ax - share * dx, y - ay - share * dy);
}

/**
 * Return a unit vector as the student would write it: "+y" along an axis of the base frame, else its coordinates.
 *
 * @param {number[]} vector
 */
export function directionText(vector) {
  const i = vector.findIndex((value) => Math.abs(value) > ALONG);
  if (i >= 0) return `${vector[i] > 0 ? "+" : "-"}${"xyz"[i]}`;
  return `[${vector.map((value) => Number(value.toFixed(DIGITS)) + 0).join(", ")}]`;
}
