// A click on a joint axis in the 3D view puts z of the frame in hand there; a second click turns it over. The cells do
// the same by keyboard.

import { h } from "../../shared/dom.js";
import { directionText, nearestAxes } from "./axis_words.js";
import { worded } from "../../shared/words/words.js";

const HINT = worded("Click a joint axis: z of the frame in hand lies along it. Click it again to turn z over.");
// A pointer that moved farther, in pixels, has turned the view.
const STILL = 4;

export class AxisClicks {
  /** @type {Front.RowView | null} */
  #inHand = null;
  /** @type {Promise<number[][]> | null} */
  #directions = null;
  #stop = new AbortController();

  /**
   * `part` has the cells of the frames, `scene` draws the axes.
   *
   * @param {Front.ViewHost} host
   * @param {Front.PartView} part
   * @param {Front.RobotScene} scene
   */
  constructor(host, part, scene) {
    this.host = host;
    this.part = part;
    this.scene = scene;
    this.hint = h("p", { class: "quiet axis-hint" }, HINT);
    const { signal } = this.#stop;
    let from = [0, 0];
    scene.canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (from = [clientX, clientY]), {
      signal,
      capture: true,
    });
    scene.canvas.addEventListener("click", ({ clientX, clientY, offsetX, offsetY }) => {
      if (Math.hypot(clientX - from[0], clientY - from[1]) <= STILL) this.#clicked([offsetX, offsetY]);
    }, { signal });
    part.element.addEventListener("focusin", ({ target }) => {
      this.#inHand = part.rows.find(({ cells }) => cells.some(({ input }) => input === target)) ?? this.#inHand;
    }, { signal });
  }

  /** The row in which the student was last, or the first without an axis. */
  get #row() {
    return this.#inHand ?? this.part.rows.find((row) => !cell(row, "axis").text.trim()) ?? null;
  }

  /** @param {number[]} at pixels from the upper left corner of the stage */
  async #clicked(at) {
    const found = nearestAxes(at, this.scene.axesOnStage());
    const row = this.#row;
    const { shape } = this.part.part;
    if (!found.length || !row || !("joints" in shape) || cell(row, "axis").input.matches(":disabled, :read-only")) {
      return;
    }
    const names = found.map((i) => shape.joints[i]);
    const used = this.part.rows.map((each) => cell(each, "axis").text.trim());
    const own = cell(row, "axis").text.trim();
    // Several joints may have the same line: the frame keeps its own, else it gets one without a frame.
    const joint = names.find((name) => name === own) ?? names.find((name) => !used.includes(name)) ?? names[0];
    const directions = await this.#load().catch(() => null);
    if (!directions) return this.host.announce(worded("The directions of the axes could not be loaded"));
    const along = directions[shape.joints.indexOf(joint)];
    const [text, opposite] = [along, along.map((value) => -value)].map(directionText);
    const isAgain = joint === own && cell(row, "z").text.trim() === text;
    const z = isAgain ? opposite : text;
    this.part.write([[cell(row, "axis"), joint], [cell(row, "z"), z]]);
    this.#inHand = row;
    this.host.announce(
      worded("Frame {frame}: z along the axis of joint {joint}, {direction}", {
        frame: row.label,
        joint,
        direction: z,
      }),
    );
  }

  /** Return the directions of the axes with all joint variables 0. */
  #load() {
    this.#directions ??= this.#asked();
    this.#directions.catch(() => (this.#directions = null));
    return this.#directions;
  }

  async #asked() {
    const { exercise } = this.host.body() ?? {};
    const { shape } = this.part.part;
    const joints = "joints" in shape ? shape.joints.map(() => 0) : [];
    const { mechanism } = await this.host.service.frames({ exercise, joints: [joints] });
    return mechanism?.configurations[0].axes ?? [];
  }

  close() {
    this.#stop.abort();
  }
}

/** @param {Front.RowView} row @param {string} label */
function cell(row, label) {
  const [found] = row.cells.filter(({ place }) => place.label === label);
  return found;
}
