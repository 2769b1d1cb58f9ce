// The bar below an exercise: the Check button, the points, and errors of the connection.

import { h, points, visible } from "../shared/dom.js";
import { placed, worded } from "../shared/words/words.js";

export class CheckBar {
  /** @param {() => void} check */
  constructor(check) {
    this.button = h("button", { type: "button", class: "check", part: "check", onclick: check }, worded("Check"));
    this.total = h("p", { class: "total" });
    this.since = h("span", { class: "since" }, worded("for your answer before the change"));
    this.trouble = h("p", { class: "trouble-line", hidden: true });
    this.hinted = h("p", { class: "hint", hidden: true });
    const line = h("div", { class: "bar-line" }, this.button, this.hinted, this.total);
    this.element = h("div", { class: "bar" }, this.trouble, line);
  }

  get isBusy() {
    return this.button.getAttribute("aria-disabled") === "true";
  }

  set isBusy(isBusy) {
    if (isBusy) this.button.setAttribute("aria-disabled", "true");
    else this.button.removeAttribute("aria-disabled");
  }

  /**
   * Show an error of the service, or remove it. Return true if the error was not shown before.
   *
   * @param {Error | null} error
   */
  failed(error) {
    const text = error ? visible(error.message) : "";
    const isNew = Boolean(error) && this.trouble.textContent !== text;
    this.trouble.hidden = !error;
    if (isNew) this.trouble.textContent = text;
    return isNew;
  }

  /** Say next to the button why nothing was checked; the next change removes this text. @param {string} text */
  hint(text) {
    this.hinted.textContent = text;
    this.hinted.hidden = !text;
  }

  /**
   * Show the points of these parts.
   *
   * @param {Pick<Api.PartReport, "points" | "max_points">[]} parts
   */
  show(parts) {
    const earned = parts.reduce((sum, part) => sum + part.points, 0);
    const most = parts.reduce((sum, part) => sum + part.max_points, 0);
    const meter = h("meter", {
      min: 0,
      max: 1,
      value: most ? earned / most : 0,
      "aria-label": worded("Share of the points"),
    });
    this.total.replaceChildren(
      meter,
      ...placed(worded("{points} points"), { points: h("strong", {}, points(earned, most)) }),
    );
    this.#setOutdated(false);
  }

  /** Say that the points are for the answers before the change. */
  outdated() {
    this.hint("");
    if (this.total.childNodes.length) this.#setOutdated(true);
  }

  /** @param {boolean} isOutdated */
  #setOutdated(isOutdated) {
    this.total.classList.toggle("outdated", isOutdated);
    if (isOutdated) this.total.append(this.since);
    else this.since.remove();
  }
}
