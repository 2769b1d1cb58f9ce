// The line above the parts: the angle unit, whether the answers are saved, a link to the answers, Clear, and Help.

import { h } from "../../shared/dom.js";
import { fragment } from "../../shared/storage.js";
import { language, worded } from "../../shared/words/words.js";

export class Tools {
  /**
   * `host` is the exercise. The controls call `unitChanged` and `clear`.
   *
   * @param {Front.FormHost} host
   * @param {() => void} unitChanged
   * @param {() => void} clear
   */
  constructor(host, unitChanged, clear) {
    this.host = host;
    this.saved = h("p", { class: "quiet saved" });
    this.unit = h(
      "select",
      { "aria-label": worded("Angles without a unit"), onchange: unitChanged },
      h("option", { value: "radians" }, worded("radians")),
      h("option", { value: "degrees" }, worded("degrees")),
    );
    this.share = h(
      "button",
      { type: "button", class: "quiet-button", onclick: () => this.#share() },
      worded("Copy link"),
    );
    this.element = h(
      "div",
      { class: "tools" },
      h(
        "label",
        { class: "unit" },
        h("span", { "aria-hidden": "true" }, worded("Angles without a unit:"), " "),
        this.unit,
      ),
      this.saved,
      this.share,
      h("button", { type: "button", class: "quiet-button", onclick: clear }, worded("Clear")),
      h(
        "a",
        { class: "help-link", href: host.service.address(`help/expressions?lang=${language}`), target: "_blank" },
        worded("Help"),
      ),
    );
  }

  async #share() {
    const { service, exercise, texts } = this.host;
    const address = service.address(`exercises/${encodeURIComponent(exercise.id)}`) + fragment(texts);
    let told = worded("Link copied, with your answers");
    try {
      await navigator.clipboard.writeText(address);
    } catch {
      if (this.host.hasAttribute("linked")) {
        history.replaceState(null, "", new URL(address).hash);
        told = worded("The link is in the address bar");
      } else {
        told = worded("The browser did not allow copying");
      }
    }
    this.saved.textContent = told;
    this.host.announce(told);
  }
}
