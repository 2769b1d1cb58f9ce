// The drawing of an exercise's robot, and the button that opens the robot in 3D in its place.

import { h, visible } from "../shared/dom.js";

const CLOSED = "Move it in 3D";
const OPEN = "Back to the drawing";

export class RobotFigure {
  /** @type {Front.RobotView | null} */
  #view = null;
  #turn = 0;

  /**
   * `host` is what the view asks of its page, `shown` hears whether it is open, `failed` that it could not be loaded.
   *
   * @param {string} address the drawing's
   * @param {string} title
   * @param {Front.ViewHost} host
   * @param {(isOpen: boolean) => void} shown
   * @param {() => void} failed
   */
  constructor(address, title, host, shown, failed) {
    this.host = host;
    this.shown = shown;
    this.failed = failed;
    this.button = h(
      "button",
      { type: "button", class: "quiet-button", "aria-expanded": "false", onclick: () => this.#toggle() },
      CLOSED,
    );
    const drawing = h("img", { src: address, alt: `Drawing of the robot: ${visible(title)}`, class: "loading" });
    // The text below must not jump when the drawing arrives.
    for (const name of ["load", "error"]) drawing.addEventListener(name, () => drawing.classList.remove("loading"));
    this.figure = h("figure", {}, drawing);
  }

  /** The answers have changed, maybe the table that is drawn. */
  changed() {
    this.#view?.changed();
  }

  /**
   * Load the 3D view, which takes a moment, and open it; or close it.
   *
   * @returns {Promise<void>}
   */
  async #toggle() {
    if (this.#view) return this.close();
    const turn = this.#turn;
    this.button.setAttribute("aria-busy", "true");
    try {
      const { RobotView } = await import("../robot/robot_view.js");
      if (turn === this.#turn && !this.#view) this.#open(new RobotView(this.host));
    } catch {
      this.failed();
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
