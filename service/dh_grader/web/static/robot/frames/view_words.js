// The words next to the 3D view: a legend, and the text alternative for people who do not see the picture.

import { h } from "../../shared/dom.js";
import { gapBetween } from "./gap.js";
import { gapSentence, viewText } from "./view_text.js";
import { worded } from "../../shared/words/words.js";

// The pause in milliseconds after which a new gap is announced.
const AT_REST = 1500;

export class ViewWords {
  /** @type {Api.Frames | null} */
  #answer = null;
  #timer = 0;
  #said = "";

  /** @param {(text: string) => void} announce @param {string} unit of lengths */
  constructor(announce, unit) {
    this.announce = announce;
    this.unit = unit;
    this.text = h("p", { class: "aloud", id: "where-frames-are" });
    this.legend = h("ul", { class: "view-legend", "aria-label": worded("Legend") });
  }

  /**
   * Return the gap between the last frame of a complete table and the tool frame; null if the two cannot be compared.
   *
   * @param {Front.Picture} picture
   */
  gap({ frames, mechanism }) {
    const last = frames?.at(-1);
    const tool = mechanism?.frames.at(-1);
    if (!this.#answer?.table?.complete || !this.#answer.mechanism?.comparable || !last || !tool) return null;
    return gapBetween(last, tool);
  }

  /** @param {Api.Frames} answer */
  show(answer) {
    this.#answer = answer;
    const { table, mechanism } = answer;
    /** @type {[string, string][]} */
    const items = [["axes", "x y z"]];
    if (mechanism?.frames.length) items.push(["pale", worded("given frames")]);
    if (mechanism && table) items.push(["chain", worded("your table")]);
    if (mechanism?.comparable && table?.complete) items.push(["gap-line", worded("gap to the tool frame")]);
    this.legend.replaceChildren(...(mechanism ? items.map(legendItem) : []));
  }

  /**
   * Describe a picture. The gap is announced when nothing has changed for a while.
   *
   * @param {Front.Picture} picture
   */
  describe(picture) {
    const gap = this.gap(picture);
    this.text.textContent = viewText(
      picture,
      this.#answer?.mechanism?.frames ?? [],
      gap,
      this.#answer?.placed?.labels,
      this.unit,
    );
    clearTimeout(this.#timer);
    const said = gap && gapSentence(gap, this.unit);
    if (!said || said === this.#said) return;
    this.#timer = setTimeout(() => this.announce(this.#said = said), AT_REST);
  }

  close() {
    clearTimeout(this.#timer);
  }
}

/** @param {[string, string]} item */
function legendItem([look, text]) {
  if (look !== "axes") return h("li", {}, h("span", { class: `swatch ${look}` }), text);
  return h("li", { class: "legend" }, ...text.split(" ").map((axis) => h("i", { class: axis }, axis)));
}
