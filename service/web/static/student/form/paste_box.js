// A box for a whole table, matrix or script, which fills the cells of a part.

import { h, message } from "../../shared/dom.js";

/** @type {Record<string, string>} */
const NAMES = {
  dh_table: "Paste a whole table or script",
  find_slip: "Paste the mended table",
  link_transforms: "Paste all matrices",
  transform: "Paste a whole matrix",
  rotation: "Paste a whole matrix",
};

/**
 * Return a folded box. `fill` gets its text, and returns what went wrong, or "".
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
    "aria-label": `${part.title}: text to paste`,
    "aria-describedby": `${id}-told`,
  });
  const told = h(
    "p",
    { id: `${id}-told`, class: "quiet", role: "status" },
    "From a spreadsheet, LaTeX, MATLAB, Python or Markdown.",
  );
  const read = async () => {
    const wrong = field.value.trim() ? await fill(field.value) : "Nothing is pasted yet.";
    told.replaceChildren(...message(wrong));
    told.classList.toggle("unread", Boolean(wrong));
    if (wrong) return field.focus();
    field.value = "";
    box.open = false;
  };
  const button = h("button", { type: "button", class: "quiet-button", onclick: read }, "Fill in the cells");
  const box = h(
    "details",
    { class: "paste-box" },
    h("summary", {}, NAMES[part.kind] ?? "Paste all values"),
    field,
    told,
    button,
  );
  return box;
}
