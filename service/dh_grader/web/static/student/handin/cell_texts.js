// Converts answers, which the page around the element has set, to the texts of cells.

import { cellsOf } from "./answer_cells.js";

/**
 * Return the texts of the cells of these answers; parts that are left out become empty. Throws a TypeError if an answer
 * does not fit its cells.
 *
 * @param {Record<string, unknown>} answers
 * @param {Pick<Front.PartView, "part" | "layout">[]} parts
 * @param {Api.AngleUnit} unit
 * @returns {Front.Answers}
 */
export function textsOf(answers, parts, unit) {
  const given = parts.filter(({ part }) => Object.hasOwn(answers, part.id)).map(({ part, layout }) => {
    const state = cellsOf(layout, answers[part.id]);
    if (!state) throw new TypeError(`The answer to ${part.id} does not fit its cells.`);
    return [part.id, state];
  });
  return { unit, parts: Object.fromEntries(given) };
}
