// The robot in a browser without WebGL: a drawing by the service at the current joint values.

import { h } from "../shared/dom.js";
import { isDark } from "./palette.js";
import { worded } from "../shared/words/words.js";

export class FlatScene {
  #asked = false;
  #busy = false;
  #closed = false;
  /** @type {string | null} */
  #address = null;

  /**
   * The drawing fills the element `stage`. `draw(theme)` returns the drawing as SVG, or null.
   *
   * @param {HTMLElement} stage
   * @param {Front.DrawSvg} draw
   */
  constructor(stage, draw) {
    this.stage = stage;
    this.draw = draw;
    this.image = h("img", { class: "drawn", alt: worded("Drawing of the robot at these joint values"), hidden: true });
    stage.append(this.image);
    this.stop = new AbortController();
    const recolour = () => this.move();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour, { signal: this.stop.signal });
  }

  show() {
    return this.move();
  }

  reset() {}

  /** Request the current drawing. If a request is already running, request the drawing once after it. */
  async move() {
    this.#asked = true;
    if (this.#busy) return;
    this.#busy = true;
    while (this.#asked && !this.#closed) {
      this.#asked = false;
      // Errors are ignored here: the request for the picture shows if the service cannot be reached.
      const svg = await this.draw(isDark(this.stage) ? "dark" : "light").catch(() => null);
      if (svg && !this.#closed) this.#put(svg);
    }
    this.#busy = false;
  }

  /**
   * Show the drawing as an image, in which no script can run.
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
