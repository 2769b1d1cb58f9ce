// <dh-play>: a DH table of any robot, with its 3D view, its pose, and the table in the other convention.

import { h, message, visible } from "../shared/dom.js";
import { History } from "../shared/history.js";
import { PlayTable } from "./play_table.js";
import { card, quietButton, Results } from "./results.js";
import { freshCells, jointCount, MOST_JOINTS, MOST_ROWS, robotOf, rowsOf, withKind, without } from "./rows.js";
import { RobotView } from "../robot/robot_view.js";
import { ROBOTS } from "./robots.js";
import { Service } from "../shared/service.js";
import { packed, unpacked } from "../shared/storage.js";
import { nothingTo } from "../shared/words/phrases.js";
import { worded } from "../shared/words/words.js";

const TOKENS = new URL("../shared/tokens.css", import.meta.url).href;
const STYLE = new URL("../student/element.css", import.meta.url).href;
const PLAY_STYLE = new URL("./play.css", import.meta.url).href;
const HOME = new URL("../", import.meta.url).href;
const NAME = "#robot=";
const KEPT = "dh-grader:play";
const FIRST = worded("Stanford arm, RRPRRR");
const LETTERS = { standard: worded("Standard (distal)"), modified: worded("Modified (proximal)") };

/** @typedef {{ put(state: Front.Robot): void, focus(): void }} Place */

export class DhPlay extends HTMLElement {
  #saving = 0;
  /** @type {Front.PlayRow[]} */
  #rows = [];
  // The table before the next change.
  /** @type {Front.Robot} */
  #before;
  /** @type {Map<string, Place>} */
  #places = new Map();
  /** @type {History<Place, Front.Robot>} */
  #history = new History();

  constructor() {
    super();
    const sheets = [TOKENS, STYLE, PLAY_STYLE].map((href) => h("link", { rel: "stylesheet", href }));
    this.service = new Service(HOME);
    this.live = h("p", { class: "aloud", role: "status", "aria-live": "polite" });
    this.main = h("div", { class: "exercise with-view play" });
    this.attachShadow({ mode: "open" }).append(...sheets, this.main, this.live);
    /** @type {(text: string, value?: string) => HTMLElement} */
    const option = (text, value = text) => h("option", { value }, text);
    this.robot = h(
      "select",
      { "aria-label": worded("Start from a robot"), onchange: () => this.#chosen() },
      option(worded("Start from …"), ""),
      ...Object.keys(ROBOTS).map((name) => option(name)),
    );
    this.convention = h(
      "select",
      { "aria-label": worded("Convention"), onchange: () => this.#change(this.state) },
      ...Object.entries(LETTERS).map(([value, text]) => option(text, value)),
    );
    this.unit = h(
      "select",
      { "aria-label": worded("Angles without a unit"), onchange: () => this.#edited() },
      option(worded("radians"), "radians"),
      option(worded("degrees"), "degrees"),
    );
    this.said = h("p", { class: "quiet saved" });
    this.add = quietButton(worded("Add a row"), () => this.#addRow());
    this.table = new PlayTable(this);
    this.results = new Results(
      (latex) => this.#copy(latex, worded("LaTeX of the pose copied")),
      (rows) => this.#useConverted(rows),
    );
  }

  connectedCallback() {
    this.view = new RobotView({
      service: this.service,
      body: () => this.#body(),
      cells: () => this.table.rows.map((row) => row.cells),
      announce: (text) => this.announce(text),
      answered: (answer, isKept) => this.#answered(answer, isKept),
      moved: (picture) => this.results.showPose(picture),
    });
    this.#build(this.view);
    const shared = location.hash.startsWith(NAME) ? robotOf(unpacked(location.hash.slice(NAME.length))) : null;
    if (shared) history.replaceState(null, "", location.pathname);
    this.#show(shared ?? kept() ?? ROBOTS[FIRST]);
    this.#before = this.state;
    this.view.open();
  }

  disconnectedCallback() {
    this.view?.close();
  }

  /** @param {RobotView} view */
  #build(view) {
    this.main.replaceChildren(
      h(
        "section",
        { class: "about", tabindex: 0, "aria-labelledby": "title" },
        h(
          "header",
          {},
          h("h1", { id: "title" }, worded("Free play")),
          h("p", { class: "quiet" }, worded("Write any DH table, see its robot, and move it.")),
        ),
        view.element,
      ),
      h(
        "div",
        { class: "parts" },
        h("div", { class: "tools" }, this.robot, this.said, quietButton(worded("Copy link"), () => this.#share())),
        card(
          [h("h2", {}, worded("Table")), this.results.freedoms],
          h(
            "div",
            { class: "tools" },
            this.convention,
            h(
              "label",
              { class: "unit" },
              h("span", { "aria-hidden": "true" }, worded("Angles without a unit:"), " "),
              this.unit,
            ),
          ),
          h("div", { class: "grids" }, this.table.element),
          h(
            "p",
            { class: "reading" },
            ...message(
              worded(
                "Joint i turns by `theta_i` or slides by `d_i`. For other letters, such as `a1`, `alpha1`, `d1` or `l1`, you choose numbers below the view. Paste a whole table into one cell, or a block of cells.",
              ),
            ),
          ),
          h("div", { class: "tools" }, this.add),
        ),
        this.results.poseCard,
        this.results.convertedCard,
      ),
    );
  }

  /** @param {string} text */
  announce(text) {
    this.live.textContent = visible(text);
  }

  /** @param {string} text */
  #say(text) {
    this.said.textContent = visible(text);
    this.announce(text);
  }

  // The robot: `{convention, unit, rows: [{kind, cells}]}`.

  /** @returns {Front.Robot} */
  get state() {
    return {
      convention: this.convention.value === "modified" ? "modified" : "standard",
      unit: this.unit.value === "degrees" ? "degrees" : "radians",
      rows: this.#rows.map(({ kind }, i) => ({ kind, cells: this.table.texts[i] })),
    };
  }

  /** @param {Front.Robot} robot */
  #show({ convention, unit, rows }) {
    this.convention.value = convention;
    this.unit.value = unit;
    this.#rows = rows;
    this.table.show({ rows, convention });
    this.add.disabled = rows.length >= MOST_ROWS;
    this.results.title.textContent = convention === "standard"
      ? worded("This table in the modified (proximal) convention")
      : worded("This table in the standard (distal) convention");
    this.view?.refit();
    this.changed();
  }

  /** Return the fields of every request about the table, or null if it has no joint. */
  #body() {
    const { convention, unit, rows } = this.state;
    const structure = rows.map(({ kind }) => kind).filter((kind) => kind !== "F").join("");
    if (!structure) return null;
    return { table: { rows: this.table.texts, convention, structure, formulas: true }, angle_unit: unit };
  }

  changed() {
    this.view?.changed();
    clearTimeout(this.#saving);
    this.#saving = setTimeout(() => keep(this.state), 250);
  }

  // The methods that change the table. Each change is one step for undo.

  /**
   * Add a change of the table to the history. Keys typed into one cell are one step.
   *
   * @param {Front.PlayCell | null} [cell]
   */
  #edited(cell = null) {
    const before = this.#before;
    this.#before = this.state;
    this.#history.note([{ target: this.#place(cell?.place.at ?? [0, 0]), before, after: this.#before }], cell !== null);
    this.changed();
  }

  /**
   * Return the target of a step in the history: it restores a table, and puts the cursor into the changed cell.
   *
   * @param {[number, number]} at
   */
  #place([i, j]) {
    const key = `${i} ${j}`;
    const known = this.#places.get(key);
    if (known) return known;
    /** @type {Place} */
    const place = {
      put: (state) => this.#show(state),
      focus: () => this.#focus(i, j),
    };
    this.#places.set(key, place);
    return place;
  }

  /**
   * Put the cursor into a cell, or into the last row if the table no longer has the row of the cell.
   *
   * @param {number} i
   * @param {number} [j]
   */
  #focus(i, j = 0) {
    this.table.rows[Math.min(i, this.#rows.length - 1)].cells[j].input.focus();
  }

  /** @param {Front.Direction} direction */
  undone(direction) {
    const place = this.#history[direction]();
    if (!place) return this.announce(nothingTo(direction));
    this.#before = this.state;
    return place.focus();
  }

  /** @param {Front.PlayCell} cell */
  typed(cell) {
    this.#edited(cell);
  }

  /**
   * Put texts into cells, as one step for undo.
   *
   * @param {[Front.PlayCell, string][]} pairs
   */
  filled(pairs) {
    for (const [cell, text] of pairs) cell.put(text);
    this.#edited();
    if (pairs.length > 1) this.#say(worded("{count} cells are filled; press Ctrl+Z to undo", { count: pairs.length }));
  }

  /**
   * Show another table, as one step for undo.
   *
   * @param {Front.Robot} state
   */
  #change(state) {
    this.#show(state);
    this.#edited();
  }

  #chosen() {
    const robot = ROBOTS[this.robot.value];
    this.robot.value = "";
    if (!robot) return;
    this.view?.forget();
    this.#change(robot);
    this.announce(worded("The table is filled in."));
  }

  #addRow() {
    const { rows, ...rest } = this.state;
    const joints = jointCount(rows);
    const kind = joints < MOST_JOINTS ? "R" : "F";
    this.#change({ ...rest, rows: [...rows, { kind, cells: freshCells(kind, joints + 1) }] });
    this.#focus(rows.length);
  }

  /** @param {number} i */
  removed(i) {
    const { rows, ...rest } = this.state;
    if (rows.length === 1) return this.#say(worded("A table needs at least one row"));
    this.#change({ ...rest, rows: without(rows, i) });
    this.#focus(i);
    return this.announce(worded("Row {row} is removed.", { row: i + 1 }));
  }

  /** @param {number} i @param {string} kind */
  kindChanged(i, kind) {
    const { rows, ...rest } = this.state;
    this.#change({ ...rest, rows: withKind(rows, i, kind) });
    this.table.rows[i].choice.focus();
  }

  /** @param {string} text */
  async pasted(text) {
    try {
      const { convention, unit } = this.state;
      const table = { rows: text, structure: "R".repeat(MOST_JOINTS), formulas: true, convention };
      const { table: read } = await this.service.frames({ table, angle_unit: unit });
      if (read?.error || !read?.formulas?.cells.length) {
        return this.#say(
          read?.error
            ? worded("Not read as a table: {reason}", { reason: read.error.message })
            : worded("Not read as a table: it has no rows"),
        );
      }
      this.view?.forget();
      this.#change({ ...this.state, rows: rowsOf(read.formulas.cells.map((row) => row.map((cell) => cell.text))) });
      return this.#say(worded("The pasted table is filled in; press Ctrl+Z to undo"));
    } catch (error) {
      return this.#say(error.message);
    }
  }

  // The answers of the service.

  /** @param {Api.Frames} answer @param {boolean} isKept */
  #answered({ table }, isKept) {
    if (!table) return;
    this.table.showReadings(table);
    this.results.show(table, this.state.convention, isKept);
  }

  /** @param {Api.ConvertedRow[]} converted */
  #useConverted(converted) {
    const { rows, unit, convention } = this.state;
    // The converted table may have one more fixed row, before or after the joints.
    const kinds = rows.map(({ kind }) => kind);
    while (kinds.length < converted.length) converted[0].label === "b" ? kinds.unshift("F") : kinds.push("F");
    this.#change({
      convention: convention === "standard" ? "modified" : "standard",
      unit,
      rows: converted.map(({ cells }, i) => ({ kind: kinds[i], cells: cells.map((cell) => cell.text) })),
    });
    this.announce(worded("The table is now in the other convention."));
  }

  #share() {
    return this.#copy(
      this.service.address("play") + NAME + packed(this.state),
      worded("Link copied, with the table"),
      true,
    );
  }

  /** @param {string} text @param {string} told @param {boolean} [isLink] */
  async #copy(text, told, isLink = false) {
    try {
      await navigator.clipboard.writeText(text);
      this.#say(told);
    } catch {
      if (isLink) history.replaceState(null, "", new URL(text).hash);
      this.#say(isLink ? worded("The link is in the address bar") : worded("The browser did not allow copying"));
    }
  }
}

function kept() {
  try {
    // A tab keeps its own table; a new tab begins with the table that was changed last.
    return robotOf(JSON.parse(sessionStorage.getItem(KEPT) ?? localStorage.getItem(KEPT) ?? "null"));
  } catch {
    return null;
  }
}

/** @param {Front.Robot} state */
function keep(state) {
  try {
    sessionStorage.setItem(KEPT, JSON.stringify(state));
    localStorage.setItem(KEPT, JSON.stringify(state));
  } catch {
    // Without storage, the table is lost when the page is closed.
  }
}
