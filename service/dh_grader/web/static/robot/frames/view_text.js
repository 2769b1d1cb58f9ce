// The text alternative of the 3D view: where the tool and the frames are.

import { column } from "../motion.js";
import { isClosed, missText, short } from "./gap.js";
import { worded } from "../../shared/words/words.js";

const PARALLEL = 0.9999;

/**
 * Return sentences that say where the tool, the frames and the gap are.
 *
 * @param {Front.Picture} picture
 * @param {string[]} labels of the given frames
 * @param {Front.Gap | null} gap
 * @param {string[]} [placedLabels] of the frames that the student placed
 * @param {string} [unit] of lengths
 */
export function viewText({ frames, mechanism, placed }, labels, gap, placedLabels = [], unit = "m") {
  const lines = [];
  if (mechanism) lines.push(worded("The tool of the robot is at {point}.", { point: point(mechanism.tool) }));
  mechanism?.frames.forEach((frame, i) => lines.push(worded("Given frame {frame}: {place}.", named(labels[i], frame))));
  placed?.forEach((frame, i) => lines.push(worded("Your frame {frame}: {place}.", named(placedLabels[i], frame))));
  frames?.forEach((frame, i) => lines.push(worded("Frame {frame} of your table: {place}.", named(i, frame))));
  if (gap) lines.push(gapSentence(gap, unit));
  return lines.join(" ");
}

/**
 * Return a sentence that says how the last frame of the table misses the tool frame.
 *
 * @param {Front.Gap} gap
 * @param {string} unit
 */
export function gapSentence(gap, unit) {
  return isClosed(gap)
    ? worded("The last frame of your table lies on the tool frame.")
    : worded("The last frame of your table misses the tool frame: {gap}.", { gap: missText(gap, unit) });
}

/** @param {string | number} label @param {Front.Frame} frame */
const named = (label, frame) => ({
  frame: `{${label}}`,
  place: worded("origin {origin}, x {x}, z {z}", {
    origin: point(column(frame, 3)),
    x: direction(column(frame, 0)),
    z: direction(column(frame, 2)),
  }),
});

/** @param {number[]} coordinates */
const point = (coordinates) => `(${coordinates.map(short).join(", ")})`;

/**
 * Return a unit vector in words if it is along an axis of the base frame, else its coordinates.
 *
 * @param {number[]} vector
 */
function direction(vector) {
  const i = vector.findIndex((value) => Math.abs(value) > PARALLEL);
  if (i < 0) return worded("towards {point}", { point: point(vector) });
  const axis = "xyz"[i];
  return vector[i] > 0
    ? worded("along the base's {axis}", { axis })
    : worded("opposite to the base's {axis}", { axis });
}
