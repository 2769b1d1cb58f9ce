// A notice above the parts of an exercise, with buttons that remove it. An error message in place of an exercise.

import { h, visible } from "../../shared/dom.js";
import { worded } from "../../shared/words/words.js";

/**
 * Show a text with a button for each choice.
 *
 * @param {HTMLElement} place
 * @param {string} text
 * @param {Record<string, () => void>} choices
 */
export function offer(place, text, choices) {
  const buttons = Object.entries(choices).map(([name, choose]) => {
    const onclick = () => {
      place.hidden = true;
      choose();
    };
    return h("button", { type: "button", class: "quiet-button", onclick }, name);
  });
  place.replaceChildren(h("p", {}, text), ...buttons);
  place.hidden = false;
}

/**
 * Return a card with an error message, and with a button if the student can try `again`.
 *
 * @param {string} title
 * @param {string} text
 * @param {(() => void) | null} again
 */
export function trouble(title, text, again) {
  return h(
    "div",
    { class: "card trouble", role: "alert" },
    h("p", {}, h("strong", {}, visible(title))),
    text ? h("p", {}, visible(text)) : null,
    again ? h("button", { type: "button", class: "quiet-button", onclick: again }, worded("Try again")) : null,
  );
}
