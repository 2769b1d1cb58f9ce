// Converts a recorded answer in any form to the texts of the cells of its part.

/**
 * Return the state of a part (`cells`, `choice`) with this answer, or null if the answer does not fit the cells. A
 * text does not fit: the service has to read it first.
 *
 * @param {Front.Layout} layout
 * @param {any} answer
 * @returns {Front.PartState | null}
 */
export function cellsOf(layout, answer) {
  const widths = layout.grids.flatMap((grid) => grid.rows.map(() => grid.columns.map((column) => column.label)));
  const empty = widths.flat().map(() => "");
  if (answer === null || answer === undefined) return { cells: empty, choice: "" };
  if (answer?.none === true) return { cells: empty, choice: "none" };
  const choice = typeof answer.convention === "string" ? answer.convention : "";
  const texts = textsOf(answer.rows ?? answer, widths[0]);
  return texts?.length === empty.length ? { cells: texts, choice } : null;
}

/**
 * Return all entries in order, or null if the answer holds anything else.
 *
 * @param {any} answer
 * @param {string[]} labels
 * @returns {string[] | null}
 */
function textsOf(answer, labels) {
  if (typeof answer === "number") return [String(answer)];
  if (Array.isArray(answer)) {
    const found = answer.map((each) => (typeof each === "string" ? [each] : textsOf(each, labels)));
    const entries = found.flatMap((each) => each ?? []);
    return found.includes(null) ? null : entries;
  }
  if (answer === null || typeof answer !== "object") return null;
  // A row of a DH table, by column. An omitted column is empty.
  if (Object.keys(answer).some((name) => !labels.includes(name))) return null;
  return labels.map((label) => String(answer[label] ?? ""));
}
