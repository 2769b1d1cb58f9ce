// A box for a whole table, matrix or script, which fills the cells of a part.

import { h, message } from "../../shared/dom.js";
import { worded } from "../../shared/words/words.js";

/** @type {Record<string, string>} */
const NAMES = {
  dh_table: worded("Paste a whole table or script"),
  find_slip: worded("Paste the mended table"),
  link_transforms: worded("Paste all matrices"),
  transform: worded("Paste a whole matrix"),
  rotation: worded("Paste a whole matrix"),
};

/**
 * Return a folded box. `fill` gets the text of the box, and returns an error message, or "".
 *
 * @param {Api.Part} part
 * @param {(text: string) => Promise<string>} fill
 */
export function pasteBox(part, fill) {
  const id = `part-${part.id}-paste`;
  const field = h("textarea", {
    rows: 5,
    spellcheck: "false",
    autocapitalize: "off",
    "aria-label": worded("{part}: text to paste", { part: part.title }),
    "aria-describedby": `${id}-told`,
  });
  const told = h(
    "p",
    { id: `${id}-told`, class: "quiet", role: "status" },
    worded("From a spreadsheet, LaTeX, MATLAB, Python or Markdown."),
  );
  const read = async () => {
    const wrong = field.value.trim() ? await fill(field.value) : worded("Nothing is pasted yet.");
    told.replaceChildren(...message(wrong));
    told.classList.toggle("unread", Boolean(wrong));
    if (wrong) return field.focus();
    field.value = "";
    box.open = false;
  };
  const button = h("button", { type: "button", class: "quiet-button", onclick: read }, worded("Fill in the cells"));
  const box = h(
    "details",
    { class: "paste-box" },
    h("summary", {}, NAMES[part.kind] ?? worded("Paste all values")),
    field,
    told,
    button,
  );
  return box;
}
