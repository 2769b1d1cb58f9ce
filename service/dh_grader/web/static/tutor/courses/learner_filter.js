// The search for learners: in the list of a course, and in its gradebook.

import { tell } from "../records/records.js";
import { worded, wordedFor } from "../../shared/words/words.js";

const ACCENTS = /\p{Mn}/gu;

/** @param {string} text */
const plain = (text) => text.normalize("NFKD").replace(ACCENTS, "").toLowerCase();

/**
 * True if one of the texts contains the wanted text. Capitals and accents do not matter.
 *
 * @param {string[]} texts
 * @param {string} wanted
 */
export const isFound = (texts, wanted) => texts.some((each) => plain(each).includes(plain(wanted.trim())));

const field = document.querySelector("input[data-filters]");
if (field instanceof HTMLInputElement) {
  const list = document.getElementById(field.dataset.filters ?? "");
  const count = document.getElementById("learner-count");
  const rows = [...list?.querySelectorAll("tr") ?? []];
  const filter = () => {
    let shown = 0;
    for (const row of rows) {
      const texts = [...row.cells].slice(0, 3).map((cell) => cell.textContent ?? "");
      row.hidden = !isFound(texts, field.value);
      if (!row.hidden) shown += 1;
    }
    if (count === null) return;
    const all = wordedFor("{count} learner", "{count} learners", rows.length);
    tell(count, shown === rows.length ? all : worded("{found} of {all}", { found: shown, all }));
  };
  field.addEventListener("input", filter);
  // A browser that goes back keeps what was typed.
  filter();
}
