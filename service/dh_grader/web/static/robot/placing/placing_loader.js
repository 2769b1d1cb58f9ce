// Loads the script for clicks that place frames, if the exercise asks for frames and the browser draws in 3D.

import { h } from "../../shared/dom.js";
import { later } from "../../shared/later.js";
import { worded } from "../../shared/words/words.js";

export class PlacingLoader {
  #closed = false;
  /** @type {Front.FrameClicks | null} */
  #clicks = null;

  /** @param {Front.ViewHost} host @param {Front.Stage} stage @param {() => Front.ShownValues} shown */
  constructor(host, stage, shown) {
    this.host = host;
    this.stage = stage;
    this.shown = shown;
  }

  /** Load the script; the stage must be open. */
  async open() {
    const [part, { scene }] = [this.host.placing?.(), this.stage];
    if (!part || !scene) return;
    try {
      const { FrameClicks } = await later(import.meta.resolve("./frame_clicks.js"), () => import("./frame_clicks.js"));
      if (this.#closed) return;
      this.#clicks = new FrameClicks(this.host, part, scene, this.shown);
      this.stage.element.after(this.#clicks.hint);
    } catch {
      const told = worded("Clicks on joint axes could not be loaded. Close the 3D view and open it again.");
      this.stage.element.after(h("p", { class: "no-webgl", role: "status" }, told));
    }
  }

  close() {
    this.#closed = true;
    this.#clicks?.close();
  }
}
