// What is said of placed frames that are not drawn.

/** @type {Record<string, string>} */
const CELLS = { origin_x: "origin x", origin_y: "origin y", origin_z: "origin z" };

/**
 * Return the reason of each frame that is left out, in sentences.
 *
 * @param {Api.Frames["placed"]} [placed]
 */
export function leftOutText(placed) {
  if (placed?.error) return placed.error.message;
  const reasons = (placed?.left_out ?? []).map(({ row, column, error }) =>
    `Frame ${row}, ${CELLS[column] ?? column}: ${error.message}`
  );
  if (!reasons.length) return "";
  return `${reasons.join(" ")} The view leaves ${reasons.length > 1 ? "these frames" : "this frame"} out.`;
}
