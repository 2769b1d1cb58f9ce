// The result in the header of a part: verdict, points, and whether the answer has changed since the report.

import { h } from "../../shared/dom.js";
import { earnedInWords, mostInWords, verdictName } from "../../shared/words/phrases.js";
import { worded } from "../../shared/words/words.js";

export class PartResult {
  /** @type {Api.Verdict | null} */
  #verdict = null;

  /** @param {Api.Part} part */
  constructor(part) {
    this.part = part;
    this.badge = h("span", { class: "badge", hidden: true });
    this.since = h("span", { class: "since", hidden: true }, worded("before your change"));
    this.worth = h("span", { class: "points" }, mostInWords(part.points));
    this.elements = [this.badge, this.since, this.worth];
  }

  /** The verdict, unless the answer has changed since the report. */
  get verdict() {
    return this.since.hidden ? this.#verdict : null;
  }

  /** Show the result of a report; null removes it. @param {Api.PartReport | null} report */
  show(report) {
    this.#verdict = report?.verdict ?? null;
    this.badge.hidden = !this.#verdict;
    this.badge.textContent = this.#verdict ? verdictName(this.#verdict) : "";
    if (this.#verdict) this.badge.dataset.verdict = this.#verdict;
    this.since.hidden = true;
    this.worth.textContent = report ? earnedInWords(report.points, report.max_points) : mostInWords(this.part.points);
  }

  /** Say that the result is for the answer before the change. Return true if there is a result. */
  outdated() {
    this.since.hidden = !this.#verdict;
    return Boolean(this.#verdict);
  }
}
