// Loads the script for clicks that place frames, if the exercise asks for frames and the browser draws in 3D.

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
      const { FrameClicks } = await import("./frame_clicks.js");
      if (this.#closed) return;
      this.#clicks = new FrameClicks(this.host, part, scene, this.shown);
      this.stage.element.after(this.#clicks.hint);
    } catch {
      this.host.announce(worded("Clicks on joint axes could not be loaded"));
    }
  }

  close() {
    this.#closed = true;
    this.#clicks?.close();
  }
}
