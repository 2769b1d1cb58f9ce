// Hints on demand: each message about a mistake has a button. It shows what to look at, then the rule with a picture,
// then the rule for this row. Between two steps, the student changes the answer and checks it again. For submitted
// answers, the service records each step, and a step may have a price.

import { h, visible } from "../../shared/dom.js";
import { priceInWords, pricesOf, tryFirst } from "./prices.js";
import { typesetMessage } from "../../typeset/names.js";
import { offerChoices } from "./choices.js";
import { offerSolution } from "./solution.js";
import { worded } from "../../shared/words/words.js";

const STYLE = new URL("./hints.css", import.meta.url).href;
const STEPS = 3;
const UNREAD = ["unreadable", "missing"];

/** The hints that were shown at a place; `tried` are the answers to which the last hint was given. */
/** @typedef {{ steps: Api.Hint[], tried: string }} Had */

/** @type {WeakMap<Api.Exercise, Map<string, Had>>} */
const ALL = new WeakMap();

/**
 * Add hints to the messages of a report on the answers in the cells.
 *
 * @param {Front.HintHost} host
 * @param {Front.PartView[]} parts
 * @param {Api.Report} report
 * @param {string} attempt the id of the recorded attempt with this report, if there is one
 */
export function offerHints(host, parts, report, attempt = "") {
  if (!host.shadowRoot?.querySelector(`link[href="${STYLE}"]`)) {
    /** @type {HTMLLinkElement} */
    const link = h("link", { rel: "stylesheet", href: STYLE, onerror: () => link.remove() });
    host.shadowRoot?.append(link);
  }
  const prices = pricesOf(host.handIn, attempt);
  const isFree = !host.handIn || (host.handIn.mayPractise && !host.handIn.own.exercise.hint_prices);
  const had = ALL.get(host.exercise) ?? new Map();
  ALL.set(host.exercise, had);
  offerSolution(host, parts, report);
  const answered = { answers: host.answers, angle_unit: host.angleUnit };
  for (const view of parts) {
    const part = report.parts.find((each) => each.part === view.part.id);
    if (!part) continue;
    if (!host.handIn || host.handIn.mayPractise) offerChoices(host, view, part);
    if (!isFree && !prices) continue;
    const offered = new Set();
    for (const { element, feedback, place } of view.told) {
      // Another wrong answer in a cell may have another message. The hints at this cell continue.
      const key = JSON.stringify([part.part, place.row, place.cell]);
      if (!hasHints(feedback, verdictAt(part, place)) || offered.has(key)) continue;
      offered.add(key);
      const topic = { part: part.part, code: feedback.code, ...place };
      const earlier = had.get(key) ?? { steps: [], tried: "" };
      had.set(key, earlier);
      element.append(new HintBox(host, answered, topic, earlier, prices).element);
    }
  }
}

/**
 * True if a message is about a mistake, not about an unreadable or empty cell.
 *
 * @param {Api.Feedback} feedback
 * @param {Api.Verdict} verdict
 */
export function hasHints(feedback, verdict) {
  return feedback.severity === "error" && !UNREAD.includes(verdict);
}

/**
 * Return the verdict at a place of a part.
 *
 * @param {Api.PartReport} part
 * @param {Front.Topic} place
 */
export function verdictAt(part, { row, cell }) {
  const found = part.rows.find((each) => each.label === row);
  return found?.cells.find((each) => each.label === cell)?.verdict ?? found?.verdict ?? part.verdict;
}

class HintBox {
  /**
   * @param {Front.HintHost} host
   * @param {Pick<Api.HintRequest, "answers" | "angle_unit">} answered
   * @param {Front.Topic & { part: string, code: string }} topic
   * @param {Had} had
   * @param {Front.HintPrices | null} prices null if hints are free
   */
  constructor(host, answered, topic, had, prices) {
    this.host = host;
    this.answered = answered;
    this.topic = topic;
    this.had = had;
    this.prices = prices;
    this.symbols = new Set(host.exercise.symbols.map(({ name }) => name));
    this.button = h("button", { type: "button", class: "quiet-button", onclick: () => this.#next() });
    this.note = h("p", { class: "quiet", role: "status" });
    this.list = h("ol", { class: "hint-steps" });
    this.element = h("div", { class: "hints" }, this.list, this.button, this.note);
    this.#show();
  }

  get #isTried() {
    return this.had.tried !== JSON.stringify(this.answered);
  }

  #show() {
    const { steps } = this.had;
    this.list.hidden = steps.length === 0;
    this.list.replaceChildren(...steps.map((step, i) => this.#step(step, step.title !== steps[i - 1]?.title)));
    this.button.hidden = steps.length === STEPS || !this.#isTried;
    const name = steps.length
      ? worded("Hint {step} of {steps}", { step: steps.length + 1, steps: STEPS })
      : worded("Hint");
    const price = this.prices ? priceInWords(this.prices, this.topic, steps.length + 1) : "";
    this.button.textContent = [name, price].filter(Boolean).join(": ");
    const isOpen = steps.length > 0 && steps.length < STEPS && !this.#isTried;
    this.note.textContent = isOpen ? tryFirst(this.prices) : "";
  }

  /** @param {Api.Hint} hint @param {boolean} isNew true if the step before has another rule */
  #step({ title, text, picture, lesson }, isNew) {
    return h(
      "li",
      { tabindex: -1 },
      isNew ? h("strong", {}, ...typesetMessage(visible(title), this.symbols), ". ") : null,
      ...typesetMessage(visible(text), this.symbols),
      picture
        ? h("img", {
          class: "rule",
          src: this.host.colours.figure(this.host.service.address(picture)),
          alt: visible(worded("{rule}: the picture of this rule", { rule: title })),
        })
        : null,
      lesson
        ? h(
          "p",
          {},
          h(
            "a",
            { href: this.host.service.address(lesson), target: "_blank", rel: "noopener" },
            worded("See it move in DH in ten minutes"),
            h("span", { class: "aloud" }, " ", worded("(in a new tab)")),
          ),
        )
        : null,
    );
  }

  async #next() {
    if (this.button.getAttribute("aria-disabled") === "true") return;
    this.button.setAttribute("aria-disabled", "true");
    try {
      const asked = { ...this.topic, step: this.had.steps.length + 1 };
      const { service, exercise, handIn } = this.host;
      const hint = this.prices
        ? await service.takeHint(this.prices.attempt, asked)
        : await service.hint(exercise.id, { ...this.answered, ...asked });
      if (this.prices) handIn?.refresh();
      this.had.steps.push(hint);
      this.had.tried = JSON.stringify(this.answered);
      this.#show();
      // The button is gone, so move the focus to the hint.
      /** @type {HTMLElement | null} */ (this.list.lastElementChild)?.focus();
    } catch (error) {
      this.note.textContent = visible(error.message);
    }
    this.button.removeAttribute("aria-disabled");
  }
}
