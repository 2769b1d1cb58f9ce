// Prints the names of symbols: theta1 is θ with the index 1.

import { h } from "../shared/dom.js";

/** @type {Record<string, string>} */
const GREEK = { alpha: "α", beta: "β", gamma: "γ", theta: "θ", phi: "φ", psi: "ψ" };

/** @param {string} name */
export function symbolName(name) {
  const [, letters = name, index = ""] = name.match(/^(.*?)_?(\d*)$/s) ?? [];
  return h("span", {}, h("i", {}, GREEK[letters] ?? letters), index ? h("sub", {}, index) : null);
}
