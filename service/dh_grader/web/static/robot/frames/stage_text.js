// A text over the stage that follows a point of the scene.

import { h } from "../../shared/dom.js";
import { Vector3 } from "../../vendor/three-0.185.1.module.min.js";

export class StageText {
  /** @param {HTMLElement} stage @param {string} name of its class */
  constructor(stage, name) {
    this.element = h("output", { class: `stage-text ${name}`, "aria-hidden": "true", hidden: true });
    this.point = new Vector3();
    /** @type {{ width: number, height: number } | null} */
    this.size = null;
    stage.append(this.element);
  }

  /** @param {string} text; empty to hide it @param {Vector3} [point] */
  put(text, point) {
    if (this.element.hidden === Boolean(text)) this.element.hidden = !text;
    if (this.element.textContent !== text) {
      this.element.textContent = text;
      this.size = null;
    }
    if (point) this.point.copy(point);
  }

  /**
   * Move the text to its point, and return its room in pixels from the lower left corner.
   *
   * @param {Front.Camera} camera
   * @param {Front.Vector2} stage
   */
  follow(camera, stage) {
    if (this.element.hidden) return [];
    const at = this.point.clone().project(camera);
    // Reading the size makes the browser lay out the page, so it is read once for each text, not for each picture.
    this.size ??= { width: this.element.offsetWidth, height: this.element.offsetHeight };
    const { width, height } = this.size;
    const left = Math.max(0, Math.min(stage.x - width, ((at.x + 1) / 2) * stage.x + 8));
    const top = Math.max(0, Math.min(stage.y - height, ((1 - at.y) / 2) * stage.y - height / 2));
    this.element.style.translate = `${left}px ${top}px`;
    return [{ left, right: left + width, low: stage.y - top - height, high: stage.y - top }];
  }

  dispose() {
    this.element.remove();
  }
}
