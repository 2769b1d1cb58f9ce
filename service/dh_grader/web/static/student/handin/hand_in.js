// Submits the answers of an element: the state of the assignment, the button Hand in, and the request.

import { h, visible } from "../../shared/dom.js";
import { lastAttempt } from "./last_attempt.js";
import {
  attemptName,
  attemptPoints,
  attemptsInWords,
  datesInWords,
  hintsInWords,
  ownState,
  pointsInWords,
  refusalInWords,
  STATES,
  whyClosed,
} from "./own_state.js";
import { newKey, pauseAfter, PendingHandIn } from "./pending.js";
import { Store } from "../../shared/storage.js";
import { worded } from "../../shared/words/words.js";

const TRYING = worded("Not confirmed yet, trying again. Your answers are saved in this browser.");
const TOKEN_NEEDED = worded("Please open this exercise from your course page.");
// Milliseconds that a site has to set a token, and until the element asks the site for another token.
const PATIENCE = 10_000;
const ASKED_AGAIN = 60_000;

export class HandIn {
  #isSending = false;
  #isClosed = false;
  #askedAt = 0;
  /** @type {() => void} */
  #wake = () => {};
  #onVisible = () => document.visibilityState === "visible" && this.refresh();
  #onOnline = () => this.#wake();

  /**
   * `host` is the element, whose attribute `assignment` is `path`; `own` is the state from the service.
   *
   * @param {Front.HandInHost} host
   * @param {string} path
   * @param {Front.Own} own
   */
  constructor(host, path, own) {
    this.host = host;
    this.path = path;
    this.own = own;
    const name = `${path}/${own.exercise.exercise}:${own.learner}`;
    this.store = new Store(host.service.base, name);
    this.pending = new PendingHandIn(this.store.name);
    // Other tabs get a message on each hand-in, because a hand-in uses up an attempt.
    this.channel = new BroadcastChannel(this.store.name);
    this.channel.onmessage = () => this.refresh();
    document.addEventListener("visibilitychange", this.#onVisible);
    addEventListener("online", this.#onOnline);
    this.status = h("section", { class: "card hand-in-state", "aria-label": worded("Assignment") });
    this.told = h("p", { class: "hand-in-line", role: "status" });
    this.button = h(
      "button",
      { type: "button", class: "check", part: "check", onclick: () => this.submit() },
      worded("Hand in"),
    );
  }

  /**
   * Return an element's hand-in; null if it has no assignment. Throws an Error if the assignment is not the learner's.
   *
   * @param {Front.HandInHost} host
   * @param {string} exercise
   */
  static async of(host, exercise) {
    const path = host.getAttribute("assignment");
    if (!path) return null;
    if (!host.getAttribute("token")) await tokenNeeded(host);
    const own = ownState(await host.service.own(), path, exercise);
    if (!own) throw new Error(worded("This exercise is not one of your assignments."));
    return new HandIn(host, path, own);
  }

  /** Take over the element after its form has been created. */
  begin() {
    const { bar, form } = this.host;
    form.tools.share.hidden = true;
    bar.button.after(this.button);
    bar.element.prepend(this.told);
    this.#show();
    this.resume();
  }

  /** If the service has not confirmed a hand-in, send it again. */
  resume() {
    const waiting = this.pending.get();
    if (waiting) this.#send(waiting, true);
    else this.refresh();
  }

  close() {
    this.#isClosed = true;
    this.#wake();
    this.channel.close();
    document.removeEventListener("visibilitychange", this.#onVisible);
    removeEventListener("online", this.#onOnline);
  }

  get mayPractise() {
    return this.own.exercise.may_practise;
  }

  /** Request the present state, and show it; without a connection, the earlier state stays. */
  async refresh() {
    try {
      const own = ownState(await this.host.service.own(), this.path, this.own.exercise.exercise);
      if (own) this.own = own;
    } catch {
      return;
    }
    this.#show();
  }

  #show() {
    const { course, assignment, exercise } = this.own;
    const badge = h("span", { class: "badge", "data-state": assignment.state }, STATES[assignment.state]);
    const extended = assignment.is_extended ? h("span", { class: "badge" }, worded("extended for you")) : null;
    this.status.replaceChildren(
      h("p", {}, h("strong", {}, visible(assignment.title)), " ", badge, " ", extended ?? ""),
      h("p", {}, datesInWords(course, assignment)),
      h(
        "p",
        { class: "quiet counts" },
        [attemptsInWords(assignment, exercise), pointsInWords(exercise), hintsInWords(exercise)].filter(Boolean).join(
          " · ",
        ),
      ),
    );
    this.button.hidden = !this.host.hasAttribute("submit") || whyClosed(this.own) !== "";
    const check = this.host.bar.button;
    check.hidden = !this.mayPractise;
    check.className = this.button.hidden ? "check" : "quiet-button";
  }

  /** Submit the answers. Before the last attempt, ask for a confirmation. */
  async submit() {
    const { bar, answers } = this.host;
    if (this.#isSending || bar.isBusy || this.host.hasAttribute("readonly")) return;
    if (!Object.keys(answers).length) {
      bar.hint(this.host.form.firstStep);
      return this.host.announce(this.host.form.firstStep);
    }
    bar.isBusy = true;
    await this.refresh();
    bar.isBusy = false;
    const closed = whyClosed(this.own);
    if (closed) return this.#tell(closed);
    const { exercise: { exercise, attempts_left: left } } = this.own;
    const empty = this.host.exercise.parts.filter(({ id }) => !Object.hasOwn(answers, id)).map(({ title }) => title);
    if (left === 1 && !(await lastAttempt(this.status, empty))) return undefined;
    const feedback = /** @type {Api.FeedbackLevel | null} */ (this.host.getAttribute("feedback"));
    const body = { exercise, answers, angle_unit: this.host.angleUnit, ...(feedback ? { feedback } : {}) };
    const pending = { key: newKey(), body };
    this.pending.set(pending);
    return this.#send(pending);
  }

  /**
   * Send a hand-in until the service responds. `mayBeRecorded` is true if the response to an earlier try may be lost.
   *
   * @param {Front.Pending} pending
   * @param {boolean} mayBeRecorded
   */
  async #send(pending, mayBeRecorded = false) {
    if (this.#isSending) return;
    this.#setSending(true);
    for (let tries = 0; !this.#isClosed; tries += 1) {
      let answer;
      try {
        answer = await this.host.service.handIn(this.path, pending.key, pending.body);
      } catch (error) {
        if (error.kind === "refused" || error.kind === undefined) {
          await this.#refused(error, pending.key, mayBeRecorded || tries > 0);
          break;
        }
        this.#tell(TRYING);
        await this.#pause(pauseAfter(tries));
        continue;
      }
      this.pending.clear(pending.key);
      // The hand-in is recorded now. A later error of the page must not say that it failed.
      this.#setSending(false);
      return this.#handedIn(answer, pending.body);
    }
    this.#setSending(false);
    return undefined;
  }

  /** @param {boolean} isSending */
  #setSending(isSending) {
    this.#isSending = isSending;
    if (isSending) this.button.setAttribute("aria-disabled", "true");
    else this.button.removeAttribute("aria-disabled");
  }

  /** Wait for some seconds, or until the browser is online again. @param {number} seconds */
  #pause(seconds) {
    return new Promise((done) => {
      const waiting = setTimeout(done, 1000 * seconds);
      this.#wake = () => {
        clearTimeout(waiting);
        done(undefined);
      };
    });
  }

  /** @param {Error & { status?: number }} error @param {string} key @param {boolean} mayBeRecorded */
  async #refused(error, key, mayBeRecorded) {
    this.#tell(refusalInWords(error.message, mayBeRecorded));
    if (error.status === 401) {
      // With a new token, `resume` sends the hand-in again. If all are refused, the site is not asked without end.
      if (Date.now() - this.#askedAt > ASKED_AGAIN) this.#dispatch("token-needed", null);
      this.#askedAt = Date.now();
      return;
    }
    this.pending.clear(key);
    await this.refresh();
  }

  /** @param {Api.AttemptResponse} answer @param {Api.HandInRequest} body */
  async #handedIn({ attempt, report }, { answers }) {
    await this.refresh();
    const { exercise } = this.own;
    const name = exercise.attempts.some(({ id }) => id === attempt.id)
      ? attemptName(exercise, attempt.id)
      : worded("Points");
    this.#tell(worded("Handed in. {attempt}: {points}.", { attempt: name, points: attemptPoints(attempt, exercise) }));
    this.channel.postMessage("handed in");
    this.#dispatch("submitted", attempt);
    // Show the report at the cells only if the cells still contain the submitted answers.
    if (JSON.stringify(answers) === JSON.stringify(this.host.answers)) this.host.showReport(report, attempt.id);
    this.#dispatch("graded", { ...report, answers, attempt });
  }

  /** @param {string} name @param {unknown} detail */
  #dispatch(name, detail) {
    this.host.dispatchEvent(new CustomEvent(name, { bubbles: true, composed: true, detail }));
  }

  /** @param {string} text */
  #tell(text) {
    this.told.textContent = visible(text);
  }
}

/**
 * Ask the site for a token. If the site sets a token, the element starts again; if not, this function throws an Error.
 *
 * @param {HTMLElement} host
 * @returns {Promise<never>}
 */
function tokenNeeded(host) {
  host.dispatchEvent(new CustomEvent("token-needed", { bubbles: true, composed: true }));
  return new Promise((_, fail) => setTimeout(() => fail(new Error(TOKEN_NEEDED)), PATIENCE));
}
