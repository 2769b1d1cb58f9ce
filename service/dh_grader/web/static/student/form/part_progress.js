// The progress of an answer: which cells the student has written, which are filled, and the verdict of several rows.

/** True if the student has written the text, and not the form. @param {Front.Written} cell */
const isWritten = ({ text, prefill = "" }) => text.trim() !== "" && text.trim() !== prefill;

/**
 * True if the student has written into one of the cells.
 *
 * @param {Front.Written[]} cells
 */
export function isTouched(cells) {
  return cells.some(isWritten);
}

/**
 * Return the texts of a grid as they are sent and saved; all are empty if the student has written nothing in the grid.
 *
 * @param {Front.Written[]} cells
 */
export function sentTexts(cells) {
  return isTouched(cells) ? cells.map(({ text }) => text) : cells.map(() => "");
}

/**
 * Return the saved texts of a grid; if all are empty, return the texts that the form fills in.
 *
 * @param {Front.Written[]} cells
 * @param {string[]} saved
 */
export function shownTexts(cells, saved) {
  return saved.some((text) => text.trim() !== "") ? saved : cells.map(({ prefill = "" }) => prefill);
}

/**
 * Return how many groups of cells are filled; a group in which the student has written nothing is not filled.
 *
 * @param {Front.Written[][]} groups
 */
export function filled(groups) {
  return groups.filter((cells) => isTouched(cells) && cells.every(({ text }) => text.trim() !== "")).length;
}

/**
 * Return one verdict for several rows, or null if a row has no verdict.
 *
 * @param {(Api.Verdict | null)[]} verdicts
 * @returns {Api.Verdict | null}
 */
export function together(verdicts) {
  const [first] = verdicts;
  if (!first || verdicts.includes(null)) return null;
  return verdicts.every((verdict) => verdict === first) ? first : "partial";
}
