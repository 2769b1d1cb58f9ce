// The question before the last attempt at an exercise.

import { h, visible } from "../../shared/dom.js";

/**
 * Ask whether to use the last attempt; `empty` are the titles of the parts that are not filled in.
 *
 * @param {HTMLElement} place
 * @param {string[]} empty
 * @returns {Promise<boolean>}
 */
export function lastAttempt(place, empty) {
  const dialog = h(
    "dialog",
    { class: "card", "aria-labelledby": "last-attempt" },
    h("h2", { id: "last-attempt" }, "Hand in your last attempt?"),
    h("p", {}, "You cannot hand this exercise in again."),
    empty.length ? h("p", {}, `Not filled in: ${visible(empty.join(", "))}.`) : null,
    h(
      "form",
      { method: "dialog", class: "choices" },
      h("button", { class: "check", value: "yes" }, "Hand in"),
      h("button", { class: "quiet-button", value: "no", autofocus: true }, "Not yet"),
    ),
  );
  place.append(dialog);
  dialog.showModal();
  return new Promise((done) =>
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(dialog.returnValue === "yes");
    })
  );
}
