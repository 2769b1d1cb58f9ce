// A notice above the parts of an exercise, with choices that remove it.

import { h } from "../../shared/dom.js";

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
