// <dh-exercise exercise="scara">: an element that shows an exercise on any page, to read, fill in and check.
//
// docs/embedding.md describes its attributes, properties, methods and events. `linked` is for the service's own
// pages: the element reads answers from the address, and its title is the page's heading.

import { h, visible } from "../shared/dom.js";
import { History } from "../shared/history.js";
import { keepProgress } from "../catalogue/progress.js";
import { about, source } from "./about.js";
import { CheckBar } from "./check_bar.js";
import { PageColours } from "./embedding/page_colours.js";
import { conventionLine } from "./convention_line.js";
import { Form } from "./form/form.js";
import { textsOf } from "./handin/cell_texts.js";
import { HandIn } from "./handin/hand_in.js";
import { offer, trouble } from "./handin/notice.js";
import { PartView } from "./part_view.js";
import { PracticeBar } from "./practice/practice_bar.js";
import { Previewer } from "./previewer.js";
import { ATTRIBUTES } from "./embedding/attributes.js";
import { lock } from "./embedding/readonly.js";
import { answersToDraw, RobotFigure, tableWords } from "./robot_figure.js";
import { later } from "../shared/later.js";
import { Service } from "../shared/service.js";
import { answersIn, Store } from "../shared/storage.js";
import { resultInWords } from "../shared/words/phrases.js";
import { worded } from "../shared/words/words.js";

const TOKENS = new URL("../shared/tokens.css", import.meta.url).href;
const STYLE = new URL("./element.css", import.meta.url).href;
const HAND_IN = new URL("./handin/hand_in.css", import.meta.url).href;
const PAPER = new URL("../pages/print.css", import.meta.url).href;
const HOME = new URL("../", import.meta.url).href;
const SAVED_AFTER = 250;

export class DhExercise extends HTMLElement {
  static observedAttributes = ATTRIBUTES;

  /** @type {PartView[]} */
  #parts = [];
  #speaking = 0;
  #saving = 0;
  #loading = 0;
  #isUnsaved = false;
  #onOnline = () => this.#online();
  // Save the last texts when the student leaves or reloads the page.
  #onLeaving = () => this.#isUnsaved && this.save();

  // The following fields are set whenever an exercise has been loaded.
  /** @type {Service} */
  service;
  /** @type {Api.Exercise} */
  exercise;
  /** @type {Previewer} */
  previewer;
  /** @type {Store} */
  store;
  /** @type {History<Front.PartCell, string>} */
  history;
  /** @type {RobotFigure | null} */
  robot = null;
  /** @type {HTMLSelectElement} */
  unit;
  /** @type {HTMLElement} */
  saved;
  /** @type {CheckBar} */
  bar;
  /** @type {Form} */
  form;
  /** @type {HandIn | null} */
  handIn = null;

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    this.live = h("p", { class: "aloud", role: "status", "aria-live": "polite" });
    // Shows the page's own content until the exercise has been loaded.
    this.main = h("div", { class: "exercise" }, h("slot"));
    this.state = h("div", { class: "state" });
    this.practice = new PracticeBar(this);
    this.received = h("div", { class: "card notice" });
    const sheets = [TOKENS, STYLE, HAND_IN, PAPER].map((href) => h("link", { rel: "stylesheet", href }));
    const outer = h("div", { class: "outer" }, this.practice.element, this.state, this.main, this.live);
    this.colours = new PageColours(this, outer, () => this.robot?.recolour());
    root.append(...sheets, outer);
  }

  connectedCallback() {
    this.colours.start();
    this.#begin();
    addEventListener("online", this.#onOnline);
    addEventListener("pagehide", this.#onLeaving);
  }

  disconnectedCallback() {
    this.colours.stop();
    removeEventListener("online", this.#onOnline);
    removeEventListener("pagehide", this.#onLeaving);
    this.#onLeaving();
    this.robot?.close();
    this.handIn?.close();
    this.store?.close();
    this.#loading += 1;
  }

  /** @param {string} name @param {string | null} before @param {string | null} after */
  attributeChangedCallback(name, before, after) {
    if (!this.isConnected || before === after) return;
    if (name === "token") {
      // A new token does not change the exercise. Send again what the service has refused without the token.
      if (this.handIn) this.handIn.resume();
      else if (this.hasAttribute("assignment")) this.#begin();
      return;
    }
    this.colours.start();
    this.#begin();
  }

  /** Load the exercise once, even if several attributes change at the same time. */
  #begin() {
    const turn = ++this.#loading;
    queueMicrotask(() => turn === this.#loading && this.isConnected && this.#load(turn));
  }

  /** @param {number} turn */
  async #load(turn) {
    const id = this.getAttribute("exercise");
    if (!id && !this.hasAttribute("practice")) {
      return this.#tell(
        worded("No exercise is chosen"),
        worded("Set the attribute “exercise” to the id of an exercise."),
      );
    }
    const base = new URL(this.getAttribute("api") ?? HOME, document.baseURI).href.replace(/\/?$/, "/");
    this.service = new Service(base, () => this.getAttribute("token"), () => this.getAttribute("assignment"));
    this.main.setAttribute("aria-busy", "true");
    this.state.replaceChildren(
      h("div", { class: "progress", role: "progressbar", "aria-label": worded("Loading the exercise") }),
    );
    try {
      if (!id) return await this.practice.deal();
      const [exercise, handIn] = await Promise.all([this.service.exercise(id), HandIn.of(this, id)]);
      if (turn === this.#loading) this.#show(exercise, handIn);
      else handIn?.close();
    } catch (error) {
      if (turn !== this.#loading) return undefined;
      if (error.status === 404) this.#tell(error.message);
      else this.#tell(worded("The exercise could not be loaded"), error.message, true);
    }
    return this.main.removeAttribute("aria-busy");
  }

  /**
   * Show a message instead of an exercise. If the student can try `again`, the page's own content stays.
   *
   * @param {string} title
   * @param {string} [text]
   * @param {boolean} [again]
   */
  #tell(title, text = "", again = false) {
    this.main.hidden = !again;
    this.state.replaceChildren(trouble(title, text, again ? () => this.#begin() : null));
  }

  #online() {
    if (this.exercise) this.failed(null);
    else this.#begin();
  }

  // The methods that the parts call.

  /** Return the fields that every request about entries has. */
  context() {
    return { exercise: this.exercise.id, angle_unit: this.angleUnit };
  }

  /**
   * Announce a text to screen readers after a pause, unless another text is announced meanwhile.
   *
   * @param {string} text
   * @param {number} [pause]
   */
  announce(text, pause = 0) {
    clearTimeout(this.#speaking);
    this.#speaking = setTimeout(() => (this.live.textContent = visible(text)), pause);
  }

  /**
   * Show an error of the service; null removes it.
   *
   * @param {Error | null} error
   */
  failed(error) {
    if (this.bar.failed(error)) this.announce(String(error?.message));
  }

  /** Save the changed answers after a pause. */
  edited() {
    this.robot?.changed();
    this.#isUnsaved = true;
    clearTimeout(this.#saving);
    this.#saving = setTimeout(() => this.save(), SAVED_AFTER);
    this.#outdated();
  }

  #outdated() {
    this.bar.outdated();
    this.form.rail.update();
    this.form.leaveSlip();
  }

  save() {
    clearTimeout(this.#saving);
    const empty = this.#parts.every((part) => part.isEmpty);
    const kept = this.store.save(empty ? null : this.texts);
    this.#isUnsaved = !kept;
    if (!kept && this.store.isChanged) this.#askWhich();
    this.saved.textContent = !kept ? this.store.unsaved : empty ? "" : worded("Saved in this browser");
    this.dispatchEvent(new CustomEvent("changed", { bubbles: true, composed: true }));
  }

  get angleUnit() {
    return this.form.angleUnit;
  }

  /** The answers that are filled in, as the service takes them: `{table: {rows: …}}`. */
  get answers() {
    const filled = this.#parts.filter((part) => !part.isEmpty);
    return Object.fromEntries(filled.map((part) => [part.part.id, part.answer]));
  }

  /** @param {Record<string, unknown>} answers parts that are left out become empty */
  set answers(answers) {
    this.texts = textsOf(answers, this.#parts, this.angleUnit);
  }

  /** Hand the answers in to the assignment. */
  submit() {
    return this.handIn?.submit();
  }

  /** Empty all cells. */
  reset() {
    this.texts = { unit: this.angleUnit, parts: {} };
  }

  /** The texts of all cells: `{unit, parts: {id: {cells, choice}}}`. */
  get texts() {
    const filled = this.#parts.filter((part) => !part.isEmpty);
    return { unit: this.angleUnit, parts: Object.fromEntries(filled.map((part) => [part.part.id, part.state])) };
  }

  /** @param {Front.Answers} answers the student can undo it */
  set texts(answers) {
    this.history.note(this.#restore(answers));
    for (const part of this.#parts) part.clearReport();
    this.edited();
  }

  /** @param {Front.Answers} answers */
  #restore(answers) {
    this.unit.value = answers.unit;
    this.robot?.changed();
    return this.#parts.flatMap((part) => {
      const state = Object.hasOwn(answers.parts, part.part.id) ? answers.parts[part.part.id] : null;
      return part.restore(state ?? { cells: [], choice: "" });
    });
  }

  // The exercise on the page.

  /** @param {Api.Exercise} exercise @param {HandIn | null} handIn */
  #show(exercise, handIn) {
    this.#onLeaving();
    this.#isUnsaved = false;
    this.robot?.close();
    this.handIn?.close();
    this.store?.close();
    this.handIn = handIn;
    this.exercise = exercise;
    this.robot = this.#robotFigure();
    this.history = new History();
    this.previewer = new Previewer(this.service, () => this.context(), (error) => this.failed(error));
    this.store = handIn?.store ?? new Store(this.service.base, exercise.id);
    const wanted = this.getAttribute("parts")?.trim().split(/[\s,]+/);
    // The title of the exercise is the page's heading.
    const isOwn = this.hasAttribute("linked");
    this.bar = new CheckBar(() => this.check());
    this.form = new Form(this, () => this.#clear());
    this.unit = this.form.tools.unit;
    this.saved = this.form.tools.saved;
    this.#parts = exercise.parts
      .filter((part) => !wanted || wanted.includes(part.id))
      .map((part) => new PartView(part, this, isOwn ? "h2" : "h3"));
    this.form.begin(this.#parts);
    this.bar.total.after(this.form.rail.element);
    for (const { element } of this.#parts) element.part.add("part");
    const task = about(exercise, this.#parts.map(({ part }) => part), isOwn ? "h1" : "h2", this.robot);
    this.#measure({ "--about-height": task, "--bar-height": this.bar.element });
    this.main.replaceChildren(
      h("div", { class: "task" }, task),
      h(
        "div",
        { class: "parts" },
        handIn?.status,
        conventionLine(exercise),
        this.form.tools.element,
        this.received,
        ...this.#parts.map((part) => part.element),
        this.bar.element,
      ),
      source(exercise),
    );
    this.main.hidden = false;
    lock(this.main, this.#parts, this.hasAttribute("readonly"));
    this.unit.disabled = this.hasAttribute("readonly");
    this.received.hidden = true;
    this.state.replaceChildren();
    const shared = isOwn ? answersIn(location.hash) : null;
    this.store.parts = this.#parts.map(({ part }) => part.id);
    this.store.listen(() => this.#changedElsewhere());
    const own = this.store.load();
    if (own) this.#restore(own);
    this.#offerSetAside();
    if (shared) this.#takeShared(shared, own);
    this.#outdated();
    this.practice.show();
    handIn?.begin();
    this.dispatchEvent(new CustomEvent("ready", { bubbles: true, composed: true }));
  }

  /** Tell the style sheet the heights of elements. @param {Record<string, HTMLElement>} elements by name */
  #measure(elements) {
    for (const [name, element] of Object.entries(elements)) {
      const measured = () => {
        this.main.style.setProperty(name, `${element.offsetHeight}px`);
        this.form.keepSlipInView();
      };
      new ResizeObserver(measured).observe(element);
    }
  }

  // The robot: its drawing and its 3D view.

  #robotFigure() {
    const { figure, symbols, title, id } = this.exercise;
    if (!figure) return null;
    const figureAddress = this.service.address(`v1/exercises/${encodeURIComponent(id)}/figure.svg`);
    const address = () => this.colours.figure(figureAddress);
    const host = {
      service: this.service,
      body: () => ({ ...this.context(), ...answersToDraw(this.#parts) }),
      ...tableWords(symbols, () => this.#parts),
      announce: (/** @type {string} */ text) => this.announce(text),
    };
    return new RobotFigure(address, title, host, (isOpen) => this.main.classList.toggle("with-view", isOpen));
  }

  // The same answers in several tabs.

  /** Show the answers of another tab. If this tab has changes of its own, ask. */
  #changedElsewhere() {
    if (this.#isUnsaved) return this.save();
    const before = this.texts;
    this.#take(this.store.load());
    const told = worded("You changed these answers in another tab. This tab now shows them, too.");
    offer(this.received, told, { [worded("Restore the earlier answers")]: () => (this.texts = before) });
    return this.announce(told);
  }

  /** Let the student choose between these answers and those that another tab has saved. */
  #askWhich() {
    const told = worded("These answers were changed in another tab.");
    offer(this.received, told, {
      [worded("Show those answers")]: () => this.#take(this.store.load()),
      [worded("Keep these answers")]: () => {
        this.store.keepMine();
        this.save();
      },
    });
    this.announce(told);
  }

  /** Offer the answers that were set aside because two tabs had changes, unless they are shown already. */
  #offerSetAside() {
    const { aside } = this.store;
    if (!aside || JSON.stringify(aside.parts) === JSON.stringify(this.texts.parts)) return;
    offer(this.received, worded("You changed these answers in two tabs. Those of one tab were set aside."), {
      [worded("Show the other answers")]: () => {
        this.store.setAside(this.texts);
        this.texts = aside;
      },
      [worded("Delete the other answers")]: () => this.store.setAside(null),
    });
  }

  /** Show saved answers as one step that the student can undo. @param {Front.Answers | null} saved */
  #take(saved) {
    this.history.note(this.#restore(saved ?? { unit: this.angleUnit, parts: {} }));
    for (const part of this.#parts) part.clearReport();
    this.saved.textContent = saved ? worded("Saved in this browser") : "";
    this.#outdated();
  }

  /**
   * Show the answers from a link. The student can restore their own.
   *
   * @param {Front.Answers} shared
   * @param {Front.Answers | null} own
   */
  #takeShared(shared, own) {
    const had = own ?? { unit: "radians", parts: {} };
    this.history.note(this.#restore(shared));
    const back = () => {
      this.history.note(this.#restore(had));
      this.edited();
    };
    const choices = own ? { [worded("Restore my own answers")]: back } : {};
    offer(this.received, worded("These answers came with the link."), choices);
    history.replaceState(null, "", location.pathname + location.search);
  }

  #clear() {
    this.reset();
    this.save();
    this.announce(worded("All cells are empty. Press Ctrl+Z in a cell to undo."));
    this.saved.textContent = worded("Cleared; press Ctrl+Z to undo");
    this.#parts[0]?.focus(this.#parts[0].cells[0]);
  }

  /** Grade all parts that are not empty, and show the report. */
  async check() {
    const { answers } = this;
    const hint = this.handIn && !this.handIn.mayPractise
      ? worded("This assignment has no check: hand the exercise in.")
      : Object.keys(answers).length
      ? ""
      : this.form.firstStep;
    this.bar.hint(hint);
    if (hint) return this.announce(hint);
    if (this.bar.isBusy || this.hasAttribute("readonly")) return;
    this.bar.isBusy = true;
    const feedback = /** @type {Api.FeedbackLevel | null} */ (this.getAttribute("feedback"));
    const body = { answers, angle_unit: this.angleUnit, ...(feedback ? { feedback } : {}) };
    try {
      const report = await this.service.grade(this.exercise.id, body);
      this.failed(null);
      this.showReport(report);
      this.dispatchEvent(new CustomEvent("graded", { bubbles: true, composed: true, detail: { ...report, answers } }));
    } catch (error) {
      this.failed(error);
    }
    this.bar.isBusy = false;
  }

  /** Show a report on the answers in the cells, recorded or not. @param {Api.Report} report @param {string} [attempt] */
  showReport(report, attempt) {
    const filled = this.#parts.filter((part) => !part.isEmpty);
    for (const part of this.#parts) {
      const told = filled.includes(part) ? report.parts.find((each) => each.part === part.part.id) : null;
      if (told) part.showReport(told);
      else part.clearReport();
    }
    const ids = new Set(this.#parts.map(({ part }) => part.id));
    this.bar.show(report.parts.filter(({ part }) => ids.has(part)));
    keepProgress(this.service.base, this.exercise, report.parts);
    const titles = new Map(filled.map(({ part: { id, title } }) => [id, title]));
    const told = report.parts.filter(({ part }) => titles.has(part));
    this.form.rail.update();
    const results = told.map((each) => resultInWords(titles.get(each.part) ?? "", each));
    this.announce([...results, this.form.leadToSlip(filled)].join(" "));
    this.#offerHints(filled, report, attempt);
  }

  /** @param {Front.PartView[]} filled @param {Api.Report} report @param {string} [attempt] */
  async #offerHints(filled, report, attempt) {
    try {
      const { offerHints } = await later(import.meta.resolve("./hints/hints.js"), () => import("./hints/hints.js"));
      offerHints(this, filled, report, attempt);
    } catch {
      this.failed(new Error(worded("Hints could not be loaded. The next check tries again.")));
    }
  }
}
