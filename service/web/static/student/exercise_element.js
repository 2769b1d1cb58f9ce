// <dh-exercise exercise="scara">: an exercise to read, fill in and check, on any page.
//
// Attributes: exercise, its id; api, the address of the service (that of this script by default);
// parts, the ids of those to show; feedback, the most that a report tells; token, the learner's, where
// the service needs keys; theme, "light", "dark" or "auto" (by default that of the page). `linked`
// belongs to the service's own page: the element takes answers from the address. The event `graded`
// (bubbling, composed) has the report as its detail.

import { h, points, visible } from "../shared/dom.js";
import { History } from "../shared/history.js";
import { html } from "../shared/markup.js";
import { PartView } from "./part_view.js";
import { Previewer } from "./previewer.js";
import { Service } from "../shared/service.js";
import { answersIn, fragment, Store } from "../shared/storage.js";

const TOKENS = new URL("../shared/tokens.css", import.meta.url).href;
const STYLE = new URL("./element.css", import.meta.url).href;
const HOME = new URL("../", import.meta.url).href;
const SAVED_AFTER = 250;

export class DhExercise extends HTMLElement {
  static observedAttributes = ["exercise", "api", "parts", "theme"];

  #parts = [];
  #timers = {};
  #loading = 0;

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    this.live = h("p", { class: "aloud", role: "status", "aria-live": "polite" });
    // Until there is an exercise, what the page itself holds is shown.
    this.main = h("div", { class: "exercise" }, h("slot"));
    this.state = h("div", { class: "state" });
    const sheets = [TOKENS, STYLE].map((href) => h("link", { rel: "stylesheet", href }));
    root.append(...sheets, h("div", { class: "outer" }, this.state, this.main, this.live));
  }

  connectedCallback() {
    this.#begin();
    this.onOnline = () => this.#online();
    addEventListener("online", this.onOnline);
  }

  disconnectedCallback() {
    removeEventListener("online", this.onOnline);
    this.#closeView();
    this.#loading += 1;
  }

  attributeChangedCallback(name, before, after) {
    if (this.isConnected && before !== after) this.#begin();
  }

  /** Load once per turn, however many attributes change. */
  #begin() {
    const turn = ++this.#loading;
    queueMicrotask(() => turn === this.#loading && this.isConnected && this.#load(turn));
  }

  async #load(turn) {
    const id = this.getAttribute("exercise");
    if (!id) return this.#tell("No exercise is chosen", "Name one in the attribute “exercise”.");
    const base = new URL(this.getAttribute("api") ?? HOME, document.baseURI).href.replace(/\/?$/, "/");
    this.service = new Service(base, () => this.getAttribute("token"));
    this.main.setAttribute("aria-busy", "true");
    this.state.replaceChildren(
      h("div", { class: "progress", role: "progressbar", "aria-label": "Loading the exercise" }),
    );
    try {
      const exercise = await this.service.exercise(id);
      if (turn === this.#loading) this.#show(exercise);
    } catch (error) {
      if (turn !== this.#loading) return undefined;
      const title = error.status === 404 ? "There is no such exercise" : "The exercise could not be loaded";
      this.#tell(title, error.message, error.status !== 404);
    }
    return this.main.removeAttribute("aria-busy");
  }

  /** A state without an exercise. */
  #tell(title, text, again = false) {
    const button = again
      ? h("button", { type: "button", class: "quiet-button", onclick: () => this.#begin() }, "Try again")
      : null;
    this.state.replaceChildren(
      h(
        "div",
        { class: "card trouble", role: "alert" },
        h("p", {}, h("strong", {}, title)),
        h("p", {}, visible(text)),
        button,
      ),
    );
  }

  #online() {
    if (this.exercise) this.failed(null);
    else this.#begin();
  }

  // What the parts need of their exercise.

  /** What every request about entries says. */
  context() {
    return { exercise: this.exercise.id, angle_unit: this.unit.value };
  }

  /** Say something to a screen reader, after a pause in which nothing else is said. */
  announce(text, pause = 0) {
    clearTimeout(this.#timers.live);
    this.#timers.live = setTimeout(() => (this.live.textContent = visible(text)), pause);
  }

  /** Show that the service does not answer; null when it does. */
  failed(error) {
    this.trouble.hidden = !error;
    if (error && this.trouble.textContent !== error.message) {
      this.trouble.textContent = visible(error.message);
      this.announce(error.message);
    }
  }

  /** The answers have changed: keep them. */
  edited() {
    this.view?.changed();
    clearTimeout(this.#timers.save);
    this.#timers.save = setTimeout(() => this.#save(), SAVED_AFTER);
    this.#showTotal(null);
  }

  #save() {
    const empty = this.#parts.every((part) => part.isEmpty);
    const kept = this.store.save(empty ? null : this.answers);
    this.saved.textContent = empty
      ? ""
      : kept
      ? "Kept in this browser"
      : "This browser keeps nothing: a reload loses the answers";
  }

  /** All answers: `{unit, parts: {id: {cells, choice}}}`. */
  get answers() {
    const parts = Object.fromEntries(
      this.#parts.filter((part) => !part.isEmpty).map((part) => [part.part.id, part.state]),
    );
    return { unit: this.unit.value, parts };
  }

  #restore(answers) {
    this.unit.value = answers.unit;
    this.view?.changed();
    return this.#parts.flatMap((part) => {
      const state = Object.hasOwn(answers.parts, part.part.id) ? answers.parts[part.part.id] : null;
      return part.restore(state ?? { cells: [], choice: "" });
    });
  }

  // The exercise on the page.

  #show(exercise) {
    this.#closeView();
    this.exercise = exercise;
    this.history = new History();
    this.previewer = new Previewer(this.service, () => this.context(), (error) => this.failed(error));
    this.store = new Store(this.service.base, exercise.id);
    const wanted = this.getAttribute("parts")?.trim().split(/[\s,]+/);
    const level = this.hasAttribute("linked") ? 1 : 2;
    this.#parts = exercise.parts
      .filter((part) => !wanted || wanted.includes(part.id))
      .map((part) => new PartView(part, this, level + 1));
    this.main.replaceChildren(
      this.#about(level),
      h(
        "div",
        { class: "parts" },
        this.#tools(),
        this.#received(),
        ...this.#parts.map((part) => part.element),
        this.#bar(),
      ),
    );
    this.state.replaceChildren();
    const shared = this.hasAttribute("linked") ? answersIn(location.hash) : null;
    const own = this.store.load();
    if (own) this.#restore(own);
    if (shared) this.#takeShared(shared, own);
    this.#showTotal(null);
    this.dispatchEvent(new CustomEvent("ready", { bubbles: true, composed: true }));
  }

  /** What is asked; beside the cells it scrolls by itself, also by keyboard. */
  #about(level) {
    const title = h(`h${level}`, { id: "title" }, visible(this.exercise.title));
    const header = h("header", {}, title, h("p", { class: "quiet" }, visible(this.exercise.source)));
    const region = { class: "about", tabindex: 0, "aria-labelledby": "title" };
    return h("section", region, header, this.#statement(), this.#symbols(level + 1));
  }

  // The robot in 3D, loaded when it is asked for.

  #viewButton() {
    this.opener = h("button", {
      type: "button",
      class: "quiet-button",
      "aria-expanded": "false",
      onclick: () => this.#toggleView(),
    }, "Move it in 3D");
    return this.opener;
  }

  async #toggleView() {
    if (this.view) return this.#closeView();
    const turn = this.#loading;
    this.opener.setAttribute("aria-busy", "true");
    try {
      const { RobotView } = await import("../robot/robot_view.js");
      if (turn === this.#loading && !this.view) this.#openView(new RobotView(this.#viewHost()));
    } catch {
      this.announce(this.saved.textContent = "The 3D view could not be loaded");
    }
    return this.opener.removeAttribute("aria-busy");
  }

  #viewHost() {
    return {
      service: this.service,
      body: () => ({ exercise: this.exercise.id, angle_unit: this.unit.value, ...this.#tableToDraw() }),
      descriptions: Object.fromEntries(this.exercise.symbols.map(({ name, description }) => [name, description])),
      announce: (text) => this.announce(text),
    };
  }

  #openView(view) {
    this.view = view;
    this.figure.hidden = true;
    this.figure.after(view.element);
    this.main.classList.add("with-view");
    this.opener.textContent = "Back to the drawing";
    this.opener.setAttribute("aria-expanded", "true");
    view.open();
  }

  #closeView() {
    if (!this.view) return;
    this.view.close();
    this.view = null;
    this.figure.hidden = false;
    this.main.classList.remove("with-view");
    this.opener.textContent = "Move it in 3D";
    this.opener.setAttribute("aria-expanded", "false");
  }

  /** The table that the student filled in, if there is one: the last one that was changed. */
  #tableToDraw() {
    const tables = this.#parts.filter(({ part, isEmpty }) => part.kind === "dh_table" && !isEmpty);
    const [table] = tables.sort((one, other) => other.changedAt - one.changedAt);
    if (!table) return {};
    const { rows, convention = table.part.shape.convention } = table.answer;
    return { table: { rows, convention: convention === "either" ? "standard" : convention } };
  }

  #statement() {
    const { statement, statement_html: markup } = this.exercise;
    const text = markup ? html(markup) : statement.trim().split(/\n\n+/).map((each) => h("p", {}, visible(each)));
    this.figure = this.#figure();
    // The button stands before what it opens: it stays in sight, and Tab goes on into the view.
    return h("div", { class: "statement" }, this.figure && this.#viewButton(), this.figure, ...text);
  }

  #figure() {
    if (!this.exercise.figure) return null;
    const theme = this.getAttribute("theme");
    const asked = theme === "light" || theme === "dark" ? `?theme=${theme}` : "";
    const address = this.service.address(`v1/exercises/${encodeURIComponent(this.exercise.id)}/figure.svg${asked}`);
    // The text below must not jump when the drawing arrives.
    const loaded = ({ target }) => target.classList.remove("loading");
    return h(
      "figure",
      {},
      h("img", {
        src: address,
        alt: `Drawing of the robot: ${visible(this.exercise.title)}`,
        class: "loading",
        onload: loaded,
        onerror: loaded,
      }),
    );
  }

  #symbols(level) {
    const symbols = this.exercise.symbols.flatMap(({ name, unit, description }) => [
      h("dt", {}, h("code", {}, visible(name))),
      h("dd", {}, visible(unit ? `${description} (${unit})` : description)),
    ]);
    return symbols.length
      ? h("section", { class: "symbols" }, h(`h${level}`, {}, "Symbols"), h("dl", {}, ...symbols))
      : null;
  }

  #received() {
    this.receivedNotice = h("div", { class: "card notice", hidden: true });
    return this.receivedNotice;
  }

  /** Answers that came by a link; the student's own can be had back. */
  #takeShared(shared, own) {
    const had = own ?? { unit: "radians", parts: {} };
    this.history.note(this.#restore(shared));
    const back = () => {
      this.history.note(this.#restore(had));
      this.edited();
      this.receivedNotice.hidden = true;
    };
    this.receivedNotice.replaceChildren(
      h("p", {}, "These answers came with the link."),
      own ? h("button", { type: "button", class: "quiet-button", onclick: back }, "Back to my own") : "",
    );
    this.receivedNotice.hidden = false;
    history.replaceState(null, "", location.pathname + location.search);
  }

  #bar() {
    this.button = h("button", { type: "button", class: "check", onclick: () => this.check() }, "Check");
    this.total = h("p", { class: "total" });
    this.trouble = h("p", { class: "trouble-line", hidden: true });
    return h("div", { class: "bar" }, this.trouble, h("div", { class: "bar-line" }, this.button, this.total));
  }

  #tools() {
    this.saved = h("p", { class: "quiet saved" });
    this.unit = h(
      "select",
      { "aria-label": "Plain numbers in angles are", onchange: () => this.#unitChanged() },
      h("option", { value: "radians" }, "radians"),
      h("option", { value: "degrees" }, "degrees"),
    );
    return h(
      "div",
      { class: "tools" },
      h("label", { class: "unit" }, h("span", { "aria-hidden": "true" }, "Plain angles in "), this.unit),
      this.saved,
      h("button", { type: "button", class: "quiet-button", onclick: () => this.#share() }, "Copy link"),
      h("button", { type: "button", class: "quiet-button", onclick: () => this.#clear() }, "Clear"),
    );
  }

  #unitChanged() {
    for (const part of this.#parts) for (const cell of part.cells) this.previewer.ask(cell);
    this.edited();
  }

  #clear() {
    this.history.note(this.#restore({ unit: this.unit.value, parts: {} }));
    for (const part of this.#parts) part.clearReport();
    this.#save();
    this.#showTotal(null);
    this.announce("All cells are empty. Ctrl+Z in a cell takes it back.");
    this.saved.textContent = "Cleared; Ctrl+Z takes it back";
    this.#parts[0]?.focus(this.#parts[0].cells[0]);
  }

  async #share() {
    const address = this.service.address(`exercises/${encodeURIComponent(this.exercise.id)}`) + fragment(this.answers);
    let told = "Link copied: it holds your answers";
    try {
      await navigator.clipboard.writeText(address);
    } catch {
      if (this.hasAttribute("linked")) {
        history.replaceState(null, "", new URL(address).hash);
        told = "The link is in the address bar";
      } else {
        told = "The browser does not let this page copy";
      }
    }
    this.saved.textContent = told;
    this.announce(told);
  }

  #showTotal(report) {
    if (report) {
      const share = report.max_points ? report.points / report.max_points : 0;
      const meter = h("meter", { min: 0, max: 1, value: share, "aria-label": "Share of the points" });
      this.total.replaceChildren(meter, h("strong", {}, points(report.points, report.max_points)), " points");
      this.total.classList.remove("outdated");
    } else if (this.total.childNodes.length) {
      this.total.classList.add("outdated");
    }
  }

  /** Have all parts graded that hold something, and show the report. */
  async check() {
    const filled = this.#parts.filter((part) => !part.isEmpty);
    if (!filled.length) {
      this.announce("Nothing is filled in yet.");
      this.saved.textContent = "Nothing is filled in yet";
      return;
    }
    if (this.button.getAttribute("aria-disabled") === "true") return;
    this.button.setAttribute("aria-disabled", "true");
    const feedback = this.getAttribute("feedback");
    const body = {
      answers: Object.fromEntries(filled.map((part) => [part.part.id, part.answer])),
      angle_unit: this.unit.value,
      ...(feedback ? { feedback } : {}),
    };
    try {
      const report = await this.service.grade(this.exercise.id, body);
      this.failed(null);
      this.#showReport(report, filled);
    } catch (error) {
      this.failed(error);
    }
    this.button.removeAttribute("aria-disabled");
  }

  #showReport(report, filled) {
    const shown = new Map(report.parts.map((part) => [part.part, part]));
    for (const part of this.#parts) {
      if (filled.includes(part)) part.showReport(shown.get(part.part.id));
      else part.clearReport();
    }
    this.#showTotal(this.#ofShown(report));
    const told = filled.map((part) => {
      const { verdict, points: earned, max_points: most } = shown.get(part.part.id);
      return `${part.part.title}: ${verdict}, ${points(earned, most)} points.`;
    });
    this.announce(told.join(" "));
    this.dispatchEvent(new CustomEvent("graded", { bubbles: true, composed: true, detail: report }));
  }

  /** Points of the parts that are shown. */
  #ofShown(report) {
    const ids = new Set(this.#parts.map((part) => part.part.id));
    const shown = report.parts.filter((part) => ids.has(part.part));
    const sum = (name) => shown.reduce((total, part) => total + part[name], 0);
    return { points: sum("points"), max_points: sum("max_points") };
  }
}
