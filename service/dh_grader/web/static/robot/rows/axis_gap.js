// The gap between the frame at the end of a row and the joint axis on which this frame must be.

import { column, dot } from "../motion.js";

const DEGREES = 180 / Math.PI;

/**
 * Return the gap between a frame's z and the joint axis on which z must be. If the joint slides, the gap has only an
 * angle, because a sliding joint has no definite axis, only a direction.
 *
 * @param {Front.Frame} frame
 * @param {{ centre: number[], axis: number[], slides: boolean }} joint
 * @returns {Front.Gap}
 */
export function axisGap(frame, { centre, axis, slides }) {
  const [z, from] = [column(frame, 2), column(frame, 3)];
  const aside = dot(axis, from) - dot(axis, centre);
  const to = slides ? from : centre.map((value, i) => value + aside * axis[i]);
  const across = [z[1] * axis[2] - z[2] * axis[1], z[2] * axis[0] - z[0] * axis[2], z[0] * axis[1] - z[1] * axis[0]];
  return {
    from,
    to,
    length: Math.hypot(...to.map((value, i) => value - from[i])),
    // The direction along the axis is not compared.
    turn: Math.atan2(Math.hypot(...across), Math.abs(dot(z, axis))) * DEGREES,
  };
}

/**
 * Return the index of the joint on whose axis the frame after row `i` must be, or null if there is none. A table may
 * begin with a fixed row before the first joint.
 *
 * @param {number} i
 * @param {number[]} rowJoints the joint of each row, or 0
 * @param {number} joints how many there are
 * @param {Api.Convention} convention
 */
export function jointAfter(i, rowJoints, joints, convention) {
  const before = rowJoints[0] === 0 && rowJoints[1] === 1 ? 1 : 0;
  const joint = i - before + (convention === "standard" ? 1 : 0);
  return joint >= 0 && joint < joints ? joint : null;
}
