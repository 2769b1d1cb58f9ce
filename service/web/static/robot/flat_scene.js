// The robot in a browser without WebGL: a drawing by the service, at the joint values as they are.

import { h } from "../shared/dom.js";
import { isDark } from "./palette.js";

export class FlatScene {
  #asked = false;
  #busy = false;
  #closed = false;
  /** @type {string | null} */
  #address = null;

  /**
   * `stage` is the element that the drawing fills; `draw(theme)` gives its SVG, or null.
   *
   * @param {HTMLElement} stage
   * @param {Front.DrawSvg} draw
   */
  constructor(stage, draw) {
    this.stage = stage;
    this.draw = draw;
    this.image = h("img", { class: "drawn", alt: "Drawing of the robot at these joint values", hidden: true });
    stage.append(this.image);
    this.stop = new AbortController();
    const recolour = () => this.move();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour, { signal: this.stop.signal });
  }

  show() {
    return this.move();
  }

  reset() {}

  /** Ask for the picture as it is; while one is on its way, once more after it. */
  async move() {
    this.#asked = true;
    if (this.#busy) return;
    this.#busy = true;
    while (this.#asked && !this.#closed) {
      this.#asked = false;
      // That the service cannot be reached is said by the request for the numbers.
      const svg = await this.draw(isDark(this.stage) ? "dark" : "light").catch(() => null);
      if (svg && !this.#closed) this.#put(svg);
    }
    this.#busy = false;
  }

  /**
   * As an image a drawing can do nothing, whatever is in it.
   *
   * @param {string} svg
   */
  #put(svg) {
    if (this.#address) URL.revokeObjectURL(this.#address);
    this.#address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    this.image.src = this.#address;
    this.image.hidden = false;
  }

  dispose() {
    this.#closed = true;
    this.stop.abort();
    if (this.#address) URL.revokeObjectURL(this.#address);
  }
}
