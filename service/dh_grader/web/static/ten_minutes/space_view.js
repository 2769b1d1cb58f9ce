// The button that opens the arm of "DH in ten minutes" in 3D, where each row can be played. It loads 3D on demand.

import { h } from "../shared/dom.js";
import { ARM } from "./tour_robot.js";
import { loadRobotView, NOT_LOADED } from "../robot/view_loader.js";
import { worded } from "../shared/words/words.js";

const CELLS = ["a", "alpha", "d", "theta"];

export class SpaceView {
  /** @type {Front.RobotView | null} */
  #view = null;
  /** @type {Api.Convention} */
  #convention = "standard";

  /** @param {Front.Service} service @param {(text: string) => void} announce */
  constructor(service, announce) {
    this.service = service;
    this.announce = announce;
    this.told = h("p", { class: "quiet", role: "status" });
    this.button = h("button", {
      type: "button",
      class: "quiet-button",
      "aria-expanded": "false",
      onclick: () => this.#toggle(),
    });
    this.element = h("div", { class: "space" }, this.button, this.told);
    this.#write();
  }

  #write() {
    this.button.textContent = this.#view ? worded("Close the 3D view") : worded("Play the rows in 3D");
    this.button.setAttribute("aria-expanded", String(Boolean(this.#view)));
  }

  /** @returns {Api.FramesRequest} */
  #body() {
    const { exercise, texts } = ARM[this.#convention];
    const rows = texts.map((row) => Object.fromEntries(CELLS.map((cell, i) => [cell, row[i]])));
    return { exercise, angle_unit: "degrees", table: { rows, convention: this.#convention } };
  }

  /** @returns {Promise<void>} */
  async #toggle() {
    if (this.#view) return this.close();
    this.button.setAttribute("aria-busy", "true");
    this.announce("");
    try {
      const RobotView = await loadRobotView();
      this.#view = new RobotView({
        service: this.service,
        body: () => this.#body(),
        unit: "m",
        announce: this.announce,
      });
      this.element.append(this.#view.element);
      this.#view.open();
    } catch {
      this.announce(NOT_LOADED);
    }
    this.button.removeAttribute("aria-busy");
    return this.#write();
  }

  /** Prepare the arm in a convention; close an open view. @param {Api.Convention} convention */
  show(convention) {
    this.#convention = convention;
    this.close();
  }

  close() {
    this.#view?.close();
    this.#view = null;
    this.#write();
  }
}
