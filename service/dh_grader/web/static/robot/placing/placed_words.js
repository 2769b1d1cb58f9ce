// The sentences about placed frames that are not drawn.

import { worded, wordedFor } from "../../shared/words/words.js";

/** @type {Record<string, string>} */
const CELLS = { origin_x: worded("origin x"), origin_y: worded("origin y"), origin_z: worded("origin z") };

/**
 * Return sentences that say why frames are left out. Frames with an empty cell get no sentence, because the student
 * is still placing them.
 *
 * @param {Api.Frames["placed"]} [placed]
 */
export function leftOutText(placed) {
  if (placed?.error) return placed.error.message;
  const unread = (placed?.left_out ?? []).filter(({ error }) => error.code !== "missing");
  const reasons = unread.map(({ row, column, error }) =>
    worded("Frame {frame}, {column}: {reason}", { frame: row, column: CELLS[column] ?? column, reason: error.message })
  );
  if (!reasons.length) return "";
  return [
    ...reasons,
    wordedFor("The view leaves this frame out.", "The view leaves these frames out.", reasons.length),
  ].join(" ");
}
