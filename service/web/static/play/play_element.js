// <dh-play>: any table of any robot, with its 3D view, its pose, and its equivalent in the other convention.

import { h, visible } from "../shared/dom.js";
import { History } from "../shared/history.js";
import { mathml, matrix } from "../shared/markup.js";
import { freshCells, jointNumbers, MOST_JOINTS, MOST_ROWS, PlayTable, rowsOf } from "./play_table.js";
import { RobotView } from "../robot/robot_view.js";
import { ROBOTS } from "./robots.js";
import { Service } from "../shared/service.js";
import { packed, unpacked } from "../shared/storage.js";

const TOKENS = new URL("../shared/tokens.css", import.meta.url).href;
const STYLE = new URL("../student/element.css", import.meta.url).href;
const PLAY_STYLE = new URL("./play.css", import.meta.url).href;
const HOME = new URL("../", import.meta.url).href;
const NAME = "#robot=";
const KEPT = "dh-grader:play";
const FIRST = "Stanford arm, RRPRRR";
const LETTERS = { standard: "Standard (distal)", modified: "Modified (proximal)" };

export class DhPlay extends HTMLElement {
  constructor() {
    super();
    const sheets = [TOKENS, STYLE, PLAY_STYLE].map((href) => h("link", { rel: "stylesheet", href }));
    this.live = h("p", { class: "aloud", role: "status", "aria-live": "polite" });
    this.main = h("div", { class: "exercise with-view play" });
    this.attachShadow({ mode: "open" }).append(...sheets, this.main, this.live);
  }

  connectedCallback() {
    this.service = new Service(HOME);
    this.table = new PlayTable(this);
    this.history = new History();
    this.view = new RobotView({
      service: this.service,
      body: () => this.#body(),
      announce: (text) => this.announce(text),
      answered: (answer, isKept) => this.#answered(answer, isKept),
      moved: (picture) => this.#showPose(picture),
    });
    this.#build();
    const shared = location.hash.startsWith(NAME) ? checked(unpacked(location.hash.slice(NAME.length))) : null;
    if (shared) history.replaceState(null, "", location.pathname);
    this.#show(shared ?? this.#kept() ?? ROBOTS[FIRST]);
    this.before = this.state;
    this.view.open();
  }

  disconnectedCallback() {
    this.view.close();
  }

  #build() {
    const option = (text, value = text) => h("option", { value }, text);
    this.robot = h(
      "select",
      { "aria-label": "Start from a robot", onchange: () => this.#chosen() },
      option("Start from …", ""),
      ...Object.keys(ROBOTS).map((name) => option(name)),
    );
    this.convention = h(
      "select",
      { "aria-label": "Convention", onchange: () => this.#conventionChosen() },
      ...Object.entries(LETTERS).map(([value, text]) => option(text, value)),
    );
    this.unit = h(
      "select",
      { "aria-label": "Plain numbers in angles are", onchange: () => this.#edited() },
      option("radians"),
      option("degrees"),
    );
    this.said = h("p", { class: "quiet saved" });
    this.add = h("button", { type: "button", class: "quiet-button", onclick: () => this.#addRow() }, "Add a row");
    const share = h("button", { type: "button", class: "quiet-button", onclick: () => this.#share() }, "Copy link");
    this.freedoms = h("p", { class: "points" });
    this.pose = h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "Pose as numbers" });
    this.formula = h("div", { class: "scroll formula", tabindex: 0, role: "group", "aria-label": "Pose as formulas" });
    this.converted = h("div", { class: "scroll" });
    this.convertedTitle = h("h2", {});
    this.latex = h("button", {
      type: "button",
      class: "quiet-button",
      onclick: () => this.#copy(this.poseLatex, "LaTeX of the pose copied"),
    }, "Copy LaTeX");
    this.use = h(
      "button",
      { type: "button", class: "quiet-button", onclick: () => this.#useConverted() },
      "Use this table",
    );
    const card = (title, ...children) => h("section", { class: "card part" }, h("header", {}, ...title), ...children);
    this.main.append(
      h(
        "section",
        { class: "about", tabindex: 0, "aria-labelledby": "title" },
        h(
          "header",
          {},
          h("h1", { id: "title" }, "Free play"),
          h("p", { class: "quiet" }, "Write any DH table, see the robot that it builds, and move it."),
        ),
        this.view.element,
      ),
      h(
        "div",
        { class: "parts" },
        h("div", { class: "tools" }, this.robot, this.said, share),
        card(
          [h("h2", {}, "Table"), this.freedoms],
          h(
            "div",
            { class: "tools" },
            this.convention,
            h("label", { class: "unit" }, h("span", { "aria-hidden": "true" }, "Plain angles in "), this.unit),
          ),
          h("div", { class: "grids" }, this.table.element),
          h(
            "p",
            { class: "reading" },
            "Joint i turns by theta_i or slides by d_i. Other letters (a1, alpha1, d1, theta1, l1 …) stand for numbers that you choose below the view. Paste a whole table into one cell, or a block of cells.",
          ),
          h("div", { class: "tools" }, this.add),
        ),
        card([h("h2", {}, "Pose of the last frame"), this.latex], this.pose, this.formula),
        card([this.convertedTitle, this.use], this.converted),
      ),
    );
  }

  announce(text) {
    this.live.textContent = visible(text);
  }

  #say(text) {
    this.said.textContent = visible(text);
    this.announce(text);
  }

  // The robot: `{convention, unit, rows: [{kind, cells}]}`.

  get state() {
    const rows = this.rows.map(({ kind }, i) => ({ kind, cells: this.table.texts[i] }));
    return { convention: this.convention.value, unit: this.unit.value, rows };
  }

  #show({ convention, unit, rows }) {
    this.convention.value = convention;
    this.unit.value = unit;
    this.rows = rows;
    this.table.show({ rows, convention });
    this.add.disabled = rows.length >= MOST_ROWS;
    this.convertedTitle.textContent = `The same in the ${
      convention === "standard" ? "modified (proximal)" : "standard (distal)"
    } convention`;
    this.view.refit();
    this.changed();
  }

  #body() {
    const structure = this.rows.map(({ kind }) => kind).filter((kind) => kind !== "F").join("");
    if (!structure) return null;
    return {
      table: { rows: this.table.texts, convention: this.convention.value, structure, formulas: true },
      angle_unit: this.unit.value,
    };
  }

  changed() {
    this.view.changed();
    clearTimeout(this.saving);
    this.saving = setTimeout(() => keep(this.state), 250);
  }

  // What changes the table. Each change is a step that can be taken back.

  /** Note that the table was changed; what is typed into one cell is one step. */
  #edited(cell = null) {
    const before = this.before;
    this.before = this.state;
    this.history.note([{ target: this.#place(cell?.place ?? [0, 0]), before, after: this.before }], cell !== null);
    this.changed();
  }

  /** What puts a table of the past back, and the cursor where it was changed. */
  #place([i, j]) {
    const key = `${i} ${j}`;
    this.places ??= new Map();
    if (!this.places.has(key)) {
      this.places.set(key, {
        put: (state) => this.#show(state),
        focus: () => this.table.rows[Math.min(i, this.rows.length - 1)].cells[j].input.focus(),
      });
    }
    return this.places.get(key);
  }

  undone(direction) {
    const place = this.history[direction]();
    if (!place) return this.announce(direction === "undo" ? "Nothing to undo" : "Nothing to redo");
    this.before = this.state;
    return place.focus();
  }

  typed(cell) {
    this.#edited(cell);
  }

  /** Put texts into cells, as one step. */
  filled(pairs) {
    for (const [cell, text] of pairs) cell.put(text);
    this.#edited();
    if (pairs.length > 1) this.#say(`${pairs.length} cells are filled; Ctrl+Z takes it back`);
  }

  /** Show another table, as one step. */
  #change(state) {
    this.#show(state);
    this.#edited();
  }

  #chosen() {
    const robot = ROBOTS[this.robot.value];
    this.robot.value = "";
    if (!robot) return;
    this.view.forget();
    this.#change(robot);
    this.announce("The table is filled in.");
  }

  #conventionChosen() {
    this.#change(this.state);
  }

  #addRow() {
    const { rows, ...rest } = this.state;
    const joints = jointNumbers(rows).filter(Boolean).length;
    const kind = joints < MOST_JOINTS ? "R" : "F";
    this.#change({ ...rest, rows: [...rows, { kind, cells: freshCells(kind, joints + 1) }] });
    this.table.rows.at(-1).cells[0].input.focus();
  }

  removed(i) {
    const { rows, ...rest } = this.state;
    if (rows.length === 1) return this.#say("A table has a row at least");
    this.#change({ ...rest, rows: renumbered(rows, rows.toSpliced(i, 1), i) });
    this.table.rows[Math.min(i, rows.length - 2)].cells[0].input.focus();
    return this.announce(`Row ${i + 1} is removed.`);
  }

  kindChanged(i, kind) {
    const { rows, ...rest } = this.state;
    const before = jointNumbers(rows)[i];
    const changed = rows.with(i, { ...rows[i], kind });
    const number = jointNumbers(changed)[i];
    // The variable moves to the column in which the joint now moves.
    const [a, alpha, d, theta] = rows[i].cells;
    const [, , freshD, freshTheta] = freshCells(kind, number);
    const isBare = (text) => ["0", "", `d${before}`, `theta${before}`, `q${before}`].includes(text.trim());
    changed[i].cells = [a, alpha, isBare(d) ? freshD : d, isBare(theta) ? freshTheta : theta];
    this.#change({ ...rest, rows: renumbered(rows, changed) });
    this.table.rows[i].element.querySelector("select").focus();
  }

  async pasted(text) {
    try {
      const table = {
        rows: text,
        structure: "R".repeat(MOST_JOINTS),
        formulas: true,
        convention: this.convention.value,
      };
      const { table: read } = await this.service.frames({ table, angle_unit: this.unit.value });
      if (read.error || !read.formulas?.cells.length) {
        return this.#say(`Not read as a table: ${read.error?.message ?? "it has no rows"}`);
      }
      this.view.forget();
      this.#change({ ...this.state, rows: rowsOf(read.formulas.cells.map((row) => row.map((cell) => cell.text))) });
      return this.#say("The pasted table is filled in; Ctrl+Z takes it back");
    } catch (error) {
      return this.#say(error.message);
    }
  }

  // What the service says.

  #answered({ table }, isKept) {
    this.table.showReadings(table);
    for (const each of [this.freedoms, this.pose, this.formula, this.converted]) each.classList.toggle("stale", isKept);
    this.use.disabled = this.latex.disabled = isKept;
    if (isKept) return;
    const { degrees_of_freedom: freedoms, formulas } = table;
    this.freedoms.textContent = freedoms === undefined
      ? ""
      : `${freedoms} degree${freedoms === 1 ? "" : "s"} of freedom`;
    const { pose, converted } = formulas ?? {};
    this.formula.hidden = !pose;
    this.formula.replaceChildren(
      pose ? h("div", { class: "bracketed" }, matrix(pose.map((row) => row.map((entry) => entry.mathml)))) : "",
    );
    this.poseFormulas = pose;
    this.convertedRows = converted;
    this.converted.closest(".card").hidden = !converted;
    this.converted.replaceChildren(converted ? convertedTable(converted, this.convention.value) : "");
  }

  #showPose({ frames }) {
    const frame = frames?.at(-1);
    this.pose.closest(".card").hidden = !frame || frames.length < 2;
    this.frame = frame;
    if (!frame) return;
    if (!this.entries) {
      this.entries = Array.from({ length: 16 }, () => h("span", { role: "cell" }));
      const row = (i) => h("span", { role: "row", class: "row" }, ...this.entries.slice(4 * i, 4 * i + 4));
      this.pose.replaceChildren(
        h("div", { class: "bracketed numeric", role: "table", "aria-label": "Pose" }, ...[0, 1, 2, 3].map(row)),
      );
    }
    frame.flat().forEach((value, i) => (this.entries[i].textContent = decimal(value)));
  }

  get poseLatex() {
    const rows = this.poseFormulas?.map((row) => row.map((entry) => entry.latex)) ??
      this.frame.map((row) => row.map(decimal));
    return `\\begin{bmatrix}\n${rows.map((row) => row.join(" & ")).join(" \\\\\n")}\n\\end{bmatrix}`;
  }

  #useConverted() {
    const rows = this.convertedRows.map(({ cells }) => cells.map((cell) => cell.text));
    const convention = this.convention.value === "standard" ? "modified" : "standard";
    // A fixed row more stands before or behind those of the joints.
    const kinds = this.rows.map(({ kind }) => kind);
    while (kinds.length < rows.length) this.convertedRows[0].label === "b" ? kinds.unshift("F") : kinds.push("F");
    this.#change({ convention, unit: this.unit.value, rows: rows.map((cells, i) => ({ kind: kinds[i], cells })) });
    this.announce("The table is now in the other convention.");
  }

  #share() {
    return this.#copy(
      this.service.address("play") + NAME + packed(this.state),
      "Link copied: it holds the table",
      true,
    );
  }

  async #copy(text, told, isLink = false) {
    try {
      await navigator.clipboard.writeText(text);
      this.#say(told);
    } catch {
      if (isLink) history.replaceState(null, "", new URL(text).hash);
      this.#say(isLink ? "The link is in the address bar" : "The browser does not let this page copy");
    }
  }

  #kept() {
    try {
      return checked(JSON.parse(localStorage.getItem(KEPT)));
    } catch {
      return null;
    }
  }
}

function keep(state) {
  try {
    localStorage.setItem(KEPT, JSON.stringify(state));
  } catch {
    // The table then lasts as long as the page.
  }
}

function decimal(value) {
  return (Math.round(value * 1000) / 1000 + 0).toFixed(3).replace("-", "−").replace(/^−(0\.000)$/, "$1");
}

/** The rows after a change, with the variables that stand alone in a cell named by their new joints. */
function renumbered(before, after, removed = null) {
  const old = jointNumbers(before).filter((_, i) => i !== removed);
  return after.map((row, i) => {
    const number = jointNumbers(after)[i];
    if (!old[i] || !number || old[i] === number) return row;
    return {
      ...row,
      cells: row.cells.map((text) => text.replace(new RegExp(`^(theta|d|q)_?${old[i]}$`), `$1${number}`)),
    };
  });
}

function convertedTable(rows, convention) {
  const index = convention === "standard" ? "i−1" : "i";
  const heads = [["a", index], ["α", index], ["d", "i"], ["θ", "i"]].map(([letter, sub]) =>
    h("th", { scope: "col" }, h("i", {}, letter), h("sub", {}, sub))
  );
  const body = rows.map(({ label, cells }) => {
    const shown = cells.map((cell) => h("td", { class: "said" }, mathml(cell.mathml) ?? visible(cell.text)));
    return h("tr", {}, h("th", { scope: "row" }, label), ...shown);
  });
  const caption = h("caption", { class: "aloud" }, "The table in the other convention");
  return h(
    "table",
    {},
    caption,
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, h("span", { class: "aloud" }, "row")), ...heads)),
    h("tbody", {}, ...body),
  );
}

/** A robot of the right shape, whatever was stored or linked; null otherwise. */
function checked(value) {
  const { convention, unit, rows } = value ?? {};
  if (!Array.isArray(rows) || !rows.length || rows.length > MOST_ROWS) return null;
  const isRow = ({ kind, cells }) =>
    ["R", "P", "F"].includes(kind) && Array.isArray(cells) && cells.length === 4 &&
    cells.every((cell) => typeof cell === "string");
  if (!rows.every((row) => row && isRow(row)) || jointNumbers(rows).filter(Boolean).length > MOST_JOINTS) return null;
  return {
    convention: convention === "modified" ? "modified" : "standard",
    unit: unit === "degrees" ? "degrees" : "radians",
    rows: rows.map(({ kind, cells }) => ({ kind, cells })),
  };
}
