// Shows the robot: in 3D, with buttons and keys to move without a mouse, or, in a browser without WebGL,
// as a drawing by the service.

import { h } from "../shared/dom.js";
import { later } from "../shared/later.js";
import { worded } from "../shared/words/words.js";

const TURN = Math.PI / 12;
const NEARER = 1.25;
const WITHOUT_WEBGL = worded(
  "This browser has no WebGL, which the 3D view needs. The service draws the robot instead.",
);
const IN_SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Return how the browser draws in 3D: "hardware", "software", or null if the browser cannot. */
function webGl() {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    if (!context) return null;
    const named = context.getExtension("WEBGL_debug_renderer_info");
    const name = context.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : context.RENDERER);
    context.getExtension("WEBGL_lose_context")?.loseContext();
    return IN_SOFTWARE.test(name) ? "software" : "hardware";
  } catch {
    return null;
  }
}

export class Stage {
  /** @type {Front.RobotScene | Front.FlatScene | null} */
  #scene = null;
  #closed = false;

  /**
   * `draw(theme)` returns the SVG of the current picture, for a browser without WebGL. `textId` is the id of the
   * picture's text alternative. `changed` is called if the 3D view replaces the drawing.
   *
   * @param {Front.DrawSvg} draw
   * @param {string} textId
   * @param {() => void} changed
   */
  constructor(draw, textId, changed) {
    this.draw = draw;
    this.textId = textId;
    this.changed = changed;
    this.room = h("div", { class: "stage" });
    this.element = h("div", { class: "stage-frame" }, this.room);
    this.isFlat = false;
  }

  /** Load the 3D view, or the drawing if that fails. */
  async open() {
    const drawnBy = webGl();
    if (drawnBy && await this.#openScene(drawnBy)) return;
    if (this.#closed) return;
    this.isFlat = true;
    this.room.classList.add("flat");
    this.room.replaceChildren(...(drawnBy ? this.#notLoaded() : [h("p", { class: "no-webgl" }, WITHOUT_WEBGL)]));
    try {
      const { FlatScene } = await later(import.meta.resolve("./flat_scene.js"), () => import("./flat_scene.js"));
      if (!this.#closed && this.isFlat) this.#scene = new FlatScene(this.room, this.draw);
    } catch {
      // Above the empty stage are the reason and the button.
    }
  }

  /** Load and open the 3D view. Return false if that fails. @param {"hardware" | "software"} drawnBy */
  async #openScene(drawnBy) {
    try {
      const { RobotScene } = await later(import.meta.resolve("./scene.js"), () => import("./scene.js"));
      if (this.#closed) return false;
      const drawing = this.isFlat ? this.#scene : null;
      const room = h("div", { class: "stage" });
      const scene = new RobotScene(room, drawnBy === "software");
      drawing?.dispose();
      this.room.replaceWith(room);
      this.room = room;
      this.isFlat = false;
      this.#scene = scene;
      this.#controls(scene);
      return true;
    } catch {
      return false;
    }
  }

  /** Return why there is only a drawing, and a button that tries to load the 3D view again. */
  #notLoaded() {
    const reason = h(
      "p",
      { class: "no-webgl", role: "status" },
      worded("The 3D view could not be loaded. The service draws the robot instead."),
    );
    const again = h("button", { type: "button", class: "quiet-button" }, worded("Try 3D again"));
    again.onclick = async () => {
      again.setAttribute("aria-busy", "true");
      const isOpen = await this.#openScene(webGl() ?? "software");
      again.removeAttribute("aria-busy");
      if (!isOpen) return;
      this.changed();
      this.element.querySelector("canvas")?.focus();
    };
    return [reason, h("p", {}, again)];
  }

  /** The 3D scene if it is open, or else null. */
  get scene() {
    return this.isFlat ? null : /** @type {Front.RobotScene | null} */ (this.#scene);
  }

  /** @param {Front.Subject} subject @param {Front.Picture} picture */
  show(subject, picture) {
    this.#scene?.show(subject, picture);
  }

  /** @param {Front.Picture} picture */
  move(picture) {
    this.#scene?.move(picture);
  }

  reset() {
    this.#scene?.reset();
  }

  close() {
    this.#closed = true;
    this.#scene?.dispose();
  }

  /** @param {Front.RobotScene} scene */
  #controls(scene) {
    const { canvas } = scene;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
      "aria-label",
      worded("The robot in 3D. Arrow keys rotate the view, plus and minus zoom, 0 resets the view."),
    );
    canvas.setAttribute("aria-describedby", this.textId);
    canvas.addEventListener("keydown", (event) => this.#pressed(event, scene));
    /** @type {(text: string, name: string, act: () => void) => HTMLElement} */
    const button = (text, name, act) =>
      h("button", { type: "button", title: name, "aria-label": name, onclick: act }, text);
    /** @type {(right: number, up: number) => () => void} */
    const turn = (right, up) => () => scene.turn(right * TURN, up * TURN);
    this.element.append(
      h(
        "div",
        { class: "stage-buttons", role: "group", "aria-label": worded("View") },
        button("←", worded("View from further left"), turn(-1, 0)),
        button("→", worded("View from further right"), turn(1, 0)),
        button("↑", worded("View from higher"), turn(0, 1)),
        button("↓", worded("View from lower"), turn(0, -1)),
        button("+", worded("Zoom in"), () => scene.turn(0, 0, NEARER)),
        button("−", worded("Zoom out"), () => scene.turn(0, 0, 1 / NEARER)),
        button("⟲", worded("Reset view"), () => scene.reset()),
      ),
    );
  }

  /** @param {KeyboardEvent} event @param {Front.RobotScene} scene */
  #pressed(event, scene) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    /** @type {Record<string, [number, number]>} */
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    /** @type {Record<string, number>} */
    const zooms = { "+": NEARER, "=": NEARER, "-": 1 / NEARER };
    const [right, up] = turns[event.key] ?? [0, 0];
    if (right || up) scene.turn(right * TURN, up * TURN);
    else if (zooms[event.key]) scene.turn(0, 0, zooms[event.key]);
    else if (event.key === "0" || event.key === "Home") scene.reset();
    else return;
    event.preventDefault();
  }
}
