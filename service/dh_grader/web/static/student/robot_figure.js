// The drawing of an exercise's robot, and the button that replaces it by the 3D view.

import { h, visible } from "../shared/dom.js";
import { loadRobotView, NOT_LOADED } from "../robot/view_loader.js";
import { worded } from "../shared/words/words.js";
import { pauseAfter } from "./handin/pending.js";

const CLOSED = worded("Move it in 3D");
const OPEN = worded("Back to the drawing");

export class RobotFigure {
  /** @type {Front.RobotView | null} */
  #view = null;
  #turn = 0;
  /** The address of the drawing. */
  #drawn = "";
  #failures = 0;
  #timer = 0;

  /**
   * The 3D view gets `host`. `shown` is called when the view opens or closes.
   *
   * @param {() => string} address of the drawing
   * @param {string} title
   * @param {Front.ViewHost} host
   * @param {(isOpen: boolean) => void} shown
   */
  constructor(address, title, host, shown) {
    this.address = address;
    this.host = host;
    this.shown = shown;
    this.button = h(
      "button",
      { type: "button", class: "quiet-button", "aria-expanded": "false", onclick: () => this.#toggle() },
      CLOSED,
    );
    // Says below the button why the view is not there.
    this.told = h("p", { class: "quiet", role: "status" });
    const drawing = this.drawing = h("img", {
      alt: worded("Drawing of the robot: {title}", { title: visible(title) }),
      class: "loading",
    });
    this.recolour();
    // Reserves space, so that the text below does not jump when the drawing arrives.
    for (const name of ["load", "error"]) drawing.addEventListener(name, () => drawing.classList.remove("loading"));
    drawing.addEventListener("load", () => (this.#failures = 0));
    drawing.addEventListener("error", () => this.#drawLater());
    this.figure = h("figure", { part: "figure" }, drawing);
  }

  /** Show the drawing in the colours of the page. */
  recolour() {
    const address = this.address();
    if (this.#drawn === address) return;
    this.#drawn = address;
    if (this.host.service.isAssigned) this.#drawOwn(address);
    else this.drawing.src = address;
  }

  /** Request the drawing again after a pause, because it did not arrive. */
  #drawLater() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => {
      if (!this.drawing.isConnected) return;
      this.#drawn = "";
      this.recolour();
    }, 1000 * pauseAfter(++this.#failures));
  }

  /** Show the drawing of the learner's variant, which needs the token. @param {string} address */
  async #drawOwn(address) {
    const picture = await this.host.service.picture(address).catch(() => "");
    this.drawing.addEventListener("load", () => URL.revokeObjectURL(picture), { once: true });
    if (picture && this.#drawn === address) this.drawing.src = picture;
    else this.drawing.classList.remove("loading");
    if (!picture) this.#drawLater();
  }

  /** Update the 3D view after the answers have changed. */
  changed() {
    this.#view?.changed();
  }

  /**
   * Load and open the 3D view, or close it.
   *
   * @returns {Promise<void>}
   */
  async #toggle() {
    if (this.#view) return this.close();
    const turn = this.#turn;
    this.button.setAttribute("aria-busy", "true");
    try {
      const RobotView = await loadRobotView();
      this.told.textContent = "";
      if (turn === this.#turn && !this.#view) this.#open(new RobotView(this.host));
    } catch {
      if (turn === this.#turn) this.told.textContent = NOT_LOADED;
    }
    return this.button.removeAttribute("aria-busy");
  }

  /** @param {Front.RobotView} view */
  #open(view) {
    this.#view = view;
    this.figure.after(view.element);
    this.#show(true);
    view.open();
  }

  close() {
    this.#turn += 1;
    if (!this.#view) return;
    this.#view.close();
    this.#view = null;
    this.#show(false);
  }

  /** @param {boolean} isOpen */
  #show(isOpen) {
    this.figure.hidden = isOpen;
    this.button.textContent = isOpen ? OPEN : CLOSED;
    this.button.setAttribute("aria-expanded", String(isOpen));
    this.shown(isOpen);
  }
}

/**
 * Return the descriptions of symbols, the unit of lengths, the cells of the table that is drawn, and the part that asks
 * for frames.
 *
 * @param {Api.ExerciseSymbol[]} symbols
 * @param {() => Front.PartView[]} parts
 */
export const tableWords = (symbols, parts) => ({
  descriptions: Object.fromEntries(symbols.map(({ name, description }) => [name, description])),
  unit: symbols.find(({ kind }) => kind === "length")?.unit,
  cells: () => drawnTable(parts())?.rows.map((row) => row.cells) ?? [],
  placing: () => parts().find(({ part }) => part.kind === "frames"),
});

/**
 * Return the table that the student changed last, if there is one.
 *
 * @param {Front.PartView[]} parts
 */
function drawnTable(parts) {
  const tables = parts.filter(({ part, isEmpty }) => part.kind === "dh_table" && !isEmpty);
  return tables.sort((one, other) => other.changedAt - one.changedAt).at(0);
}

/**
 * Return the fields of a request that draw the student's table and placed frames.
 *
 * @param {Front.PartView[]} parts
 */
export function answersToDraw(parts) {
  const frames = parts.find(({ part, isEmpty }) => part.kind === "frames" && !isEmpty);
  const placed = frames && { part: frames.part.id, rows: frames.answer };
  return { ...tableToDraw(parts), ...(placed ? { placed } : {}) };
}

/** @param {Front.PartView[]} parts */
function tableToDraw(parts) {
  const table = drawnTable(parts);
  if (!table) return {};
  const { shape } = table.part;
  const own = "convention" in shape ? shape.convention : "standard";
  const { rows, convention = own } = /** @type {{ rows: unknown, convention?: typeof own }} */ (table.answer);
  return { table: { rows, convention: convention === "either" ? "standard" : convention } };
}
