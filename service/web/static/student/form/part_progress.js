// How far an answer is: what counts as written, what is filled, and the verdict of several rows.

/** True if the student has written the text; what the form has filled in does not count. @param {Front.Written} cell */
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
 * Return the texts of a grid as they are sent and saved: all empty if the student has written nothing in it.
 *
 * @param {Front.Written[]} cells
 */
export function sentTexts(cells) {
  return isTouched(cells) ? cells.map(({ text }) => text) : cells.map(() => "");
}

/**
 * Return the saved texts of a grid as they are shown: with what the form fills in if all are empty.
 *
 * @param {Front.Written[]} cells
 * @param {string[]} saved
 */
export function shownTexts(cells, saved) {
  return saved.some((text) => text.trim() !== "") ? saved : cells.map(({ prefill = "" }) => prefill);
}

/**
 * Return how many of the groups of cells are filled; one in which the student has written nothing is not.
 *
 * @param {Front.Written[][]} groups
 */
export function filled(groups) {
  return groups.filter((cells) => isTouched(cells) && cells.every(({ text }) => text.trim() !== "")).length;
}

/**
 * Return the verdict of rows together, or null if one of them has none.
 *
 * @param {(Api.Verdict | null)[]} verdicts
 * @returns {Api.Verdict | null}
 */
export function together(verdicts) {
  const [first] = verdicts;
  if (!first || verdicts.includes(null)) return null;
  return verdicts.every((verdict) => verdict === first) ? first : "partial";
}
