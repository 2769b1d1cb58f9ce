// The grids of a part as tabs. Arrow keys, Home and End choose a tab; each tab shows the progress of its grid.

import { h, visible } from "../../shared/dom.js";
import { SIGNS } from "../../shared/cell.js";
import { typeset } from "../../typeset/names.js";
import { verdictName } from "../../shared/words/phrases.js";
import { worded } from "../../shared/words/words.js";

export class Tabs {
  /** @type {HTMLButtonElement[]} */
  #tabs = [];
  shown = 0;

  /**
   * @param {string} id
   * @param {string} name of all grids together
   * @param {string[]} titles
   * @param {HTMLElement[]} grids
   */
  constructor(id, name, titles, grids) {
    this.panels = grids.map((grid, i) =>
      h("div", { role: "tabpanel", id: `${id}-panel-${i}`, "aria-labelledby": `${id}-tab-${i}`, hidden: i > 0 }, grid)
    );
    this.#tabs = titles.map((title, i) =>
      h(
        "button",
        {
          type: "button",
          role: "tab",
          id: `${id}-tab-${i}`,
          "aria-controls": `${id}-panel-${i}`,
          "aria-selected": i === 0,
          tabindex: i === 0 ? 0 : -1,
          onclick: () => this.show(i),
          onkeydown: (event) => this.#pressed(event, i),
        },
        h("span", { "aria-hidden": "true" }, ...typeset(visible(title))),
        h("span", { class: "aloud" }, visible(title)),
        h("span", { class: "mark" }),
      )
    );
    for (const [i, tab] of this.#tabs.entries()) tab.setAttribute("aria-selected", String(i === 0));
    this.element = h("div", { class: "tabs", role: "tablist", "aria-label": name }, ...this.#tabs);
  }

  /** @param {number} chosen */
  show(chosen) {
    this.shown = chosen;
    this.#tabs.forEach((tab, i) => {
      tab.setAttribute("aria-selected", String(i === chosen));
      tab.tabIndex = i === chosen ? 0 : -1;
      this.panels[i].hidden = i !== chosen;
    });
  }

  /** @param {KeyboardEvent} event @param {number} i */
  #pressed(event, i) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const next = nextTab(event.key, i, this.#tabs.length);
    if (next === null) return;
    event.preventDefault();
    this.show(next);
    this.#tabs[next].focus();
  }

  /**
   * Mark a tab with the verdict of its grid, or, if there is no verdict, as filled.
   *
   * @param {number} i
   * @param {Api.Verdict | null} verdict
   * @param {boolean} isFilled
   */
  mark(i, verdict, isFilled) {
    const said = verdict ? verdictName(verdict) : isFilled ? worded("filled") : "";
    const tab = this.#tabs[i];
    const mark = /** @type {HTMLElement} */ (tab.lastElementChild);
    if (mark.dataset.said === said) return;
    mark.dataset.said = said;
    if (verdict) tab.dataset.verdict = verdict;
    else delete tab.dataset.verdict;
    const sign = verdict ? SIGNS[verdict] : "●";
    mark.replaceChildren(
      ...(said ? [h("span", { "aria-hidden": "true" }, sign), h("span", { class: "aloud" }, said)] : []),
    );
  }
}

/**
 * Return the tab that a key leads to, or null for another key.
 *
 * @param {string} key
 * @param {number} from
 * @param {number} count
 */
export function nextTab(key, from, count) {
  switch (key) {
    case "ArrowRight":
      return (from + 1) % count;
    case "ArrowLeft":
      return (from + count - 1) % count;
    case "Home":
      return 0;
    case "End":
      return count - 1;
    default:
      return null;
  }
}
