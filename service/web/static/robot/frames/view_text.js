// The text alternative of the 3D view: where the tool and the frames are.

import { column } from "../motion.js";
import { gapText, isClosed, short } from "./gap.js";

const PARALLEL = 0.9999;

/**
 * Return where everything is, in sentences.
 *
 * @param {Front.Picture} picture
 * @param {string[]} labels of the given frames
 * @param {Front.Gap | null} gap
 * @param {string[]} [placedLabels] of the frames that the student placed
 */
export function viewText({ frames, mechanism, placed }, labels, gap, placedLabels = []) {
  const lines = [];
  if (mechanism) lines.push(`The tool of the robot is at ${point(mechanism.tool)}.`);
  mechanism?.frames.forEach((frame, i) => lines.push(`Given frame {${labels[i]}}: ${place(frame)}.`));
  placed?.forEach((frame, i) => lines.push(`Your frame {${placedLabels[i]}}: ${place(frame)}.`));
  frames?.forEach((frame, i) => lines.push(`Frame {${i}} of your table: ${place(frame)}.`));
  if (gap) lines.push(gapSentence(gap));
  return lines.join(" ");
}

/**
 * Say how far the last frame of the table is from the tool frame.
 *
 * @param {Front.Gap} gap
 */
export function gapSentence(gap) {
  return isClosed(gap)
    ? "The last frame of your table lies on the tool frame."
    : `From the last frame of your table to the tool frame: ${gapText(gap)}.`;
}

/** @param {Front.Frame} frame */
const place = (frame) =>
  `origin ${point(column(frame, 3))}, x ${direction(column(frame, 0))}, z ${direction(column(frame, 2))}`;

/** @param {number[]} coordinates */
const point = (coordinates) => `(${coordinates.map(short).join(", ")})`;

/**
 * Return a unit vector in words if it is along an axis of the base frame, else its coordinates.
 *
 * @param {number[]} vector
 */
function direction(vector) {
  const i = vector.findIndex((value) => Math.abs(value) > PARALLEL);
  if (i < 0) return `towards ${point(vector)}`;
  return `${vector[i] > 0 ? "along" : "opposite to"} the base's ${"xyz"[i]}`;
}
