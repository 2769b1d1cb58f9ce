// The question before the last attempt at an exercise.

import { h, visible } from "../../shared/dom.js";
import { worded } from "../../shared/words/words.js";

/**
 * Ask whether to use the last attempt; `empty` has the titles of the parts that are not filled in.
 *
 * @param {HTMLElement} place
 * @param {string[]} empty
 * @returns {Promise<boolean>}
 */
export function lastAttempt(place, empty) {
  const dialog = h(
    "dialog",
    { class: "card", "aria-labelledby": "last-attempt" },
    h("h2", { id: "last-attempt" }, worded("Hand in your last attempt?")),
    h("p", {}, worded("You cannot hand this exercise in again.")),
    empty.length ? h("p", {}, worded("Not filled in: {parts}.", { parts: visible(empty.join(", ")) })) : null,
    h(
      "form",
      { method: "dialog", class: "choices" },
      h("button", { class: "check", value: "yes" }, worded("Hand in")),
      h("button", { class: "quiet-button", value: "no", autofocus: true }, worded("Not yet")),
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
