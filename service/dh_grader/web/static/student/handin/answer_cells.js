// Converts a recorded answer in any form to the texts of the cells of its part.

/**
 * Return the state of a part (`cells`, `choice`) with this answer, or null if the answer does not fit the cells. A
 * text does not fit, because the service must read it first.
 *
 * @param {Front.Layout} layout
 * @param {any} answer
 * @returns {Front.PartState | null}
 */
export function cellsOf(layout, answer) {
  const widths = layout.grids.flatMap((grid) => grid.rows.map(() => grid.columns.map((column) => column.label)));
  const empty = widths.flat().map(() => "");
  if (answer === null || answer === undefined) return { cells: empty, choice: "" };
  if (layout.marks) return markedCells(layout, answer, empty, widths[0]);
  if (answer?.none === true) return { cells: empty, choice: "none" };
  const choice = typeof answer.convention === "string" ? answer.convention : "";
  const texts = textsOf(answer.rows ?? answer, widths[0]);
  return texts?.length === empty.length ? { cells: texts, choice } : null;
}

/**
 * Return the state of a part in which students mark cells of a given table, or null if the answer does not fit.
 *
 * @param {Front.Layout} layout
 * @param {any} answer
 * @param {string[]} empty
 * @param {string[]} labels
 * @returns {Front.PartState | null}
 */
function markedCells(layout, answer, empty, labels) {
  const { marked = "", table = null, ...others } = answer;
  const texts = table === null ? empty : textsOf(table.rows ?? table, labels);
  const marks = [marked ?? ""].flat();
  if (Object.keys(others).length || texts?.length !== empty.length) return null;
  if (!marks.every((mark) => typeof mark === "string")) return null;
  const rows = layout.grids[0].rows.map(({ label }) => label);
  const known = new Set(rows.flatMap((row) => labels.map((label) => `${row}.${label}`)));
  // A mark without a column marks the whole row.
  const places = marks.flatMap((mark) => mark.split(",")).map((mark) => mark.trim()).filter(Boolean).flatMap((mark) =>
    rows.includes(mark) ? labels.map((label) => `${mark}.${label}`) : [mark]
  );
  return places.every((place) => known.has(place)) ? { cells: texts, choice: places.join(", ") } : null;
}

/**
 * Return all entries of an answer in order, or null if the answer contains anything else.
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
