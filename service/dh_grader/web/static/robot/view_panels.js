// The panels around the picture of a robot: sliders, values of symbols, frame switches, coordinates.

import { decimal, h, visible } from "../shared/dom.js";
import { gapText, isClosed } from "./frames/gap.js";
import { column } from "./motion.js";
import { symbolName } from "../typeset/names.js";
import { worded } from "../shared/words/words.js";

const STEPS = 400;
const DEGREES = 180 / Math.PI;
const LARGEST = 1e6;

/** A slider for each joint variable. */
export class JointSliders {
  /**
   * The sliders call `host`: prepare(i) before a slider moves, dragged(i, value), and released().
   *
   * @param {{ prepare(i: number): void, dragged(i: number, value: number): void, released(): void }} host
   */
  constructor(host) {
    this.host = host;
    /** @type {Api.MovingJoint[]} */
    this.joints = [];
    /** @type {{ field: HTMLInputElement, output: HTMLOutputElement, element: HTMLElement }[]} */
    this.fields = [];
    this.drawn = "";
    this.element = h("div", { class: "sliders", role: "group", "aria-label": worded("Joint variables") });
  }

  /** @param {Api.MovingJoint[]} joints @param {Record<string, number>} values */
  show(joints, values) {
    const drawn = JSON.stringify(joints.map((joint) => ({ ...joint, home: 0 })));
    if (this.drawn !== drawn) {
      this.drawn = drawn;
      this.joints = joints;
      this.fields = joints.map((joint, i) => this.#slider(joint, i));
      this.element.replaceChildren(...this.fields.map((each) => each.element));
    }
    joints.forEach(({ variable }, i) => this.put(i, values[variable]));
  }

  /** @param {Api.MovingJoint} joint @param {number} i */
  #slider({ joint, variable, kind, low, high }, i) {
    const prepare = () => this.host.prepare(i);
    const field = h("input", {
      type: "range",
      min: low,
      max: high,
      step: (high - low) / STEPS,
      "aria-label": kind === "P"
        ? worded("{variable}: joint {joint} slides", { variable, joint })
        : worded("{variable}: joint {joint} turns", { variable, joint }),
      oninput: (event) => this.host.dragged(i, Number(event.target.value)),
      onchange: () => this.host.released(),
      onpointerdown: prepare,
      onfocus: prepare,
    });
    const name = h("span", { class: "name", "aria-hidden": "true" }, symbolName(variable));
    const output = h("output");
    return { field, output, element: h("div", { class: "slider" }, name, field, output) };
  }

  /**
   * Show the value of a joint.
   *
   * @param {number} i
   * @param {number} value
   */
  put(i, value) {
    const { field, output } = this.fields[i];
    const text = this.joints[i].kind === "P" ? decimal(value) : `${Math.round(value * DEGREES)}°`;
    output.textContent = text;
    field.setAttribute("aria-valuetext", text);
    if (!field.matches(":active") && Number(field.value) !== value) field.value = String(value);
  }
}

/** Fields for the values of all symbols that are not joint variables; folded at first. */
export class SymbolFields {
  /**
   * `chosen(name, value)` is called for each new value. `descriptions` describes the symbols by name.
   *
   * @param {(name: string, value: number) => void} chosen
   * @param {Record<string, string>} [descriptions]
   */
  constructor(chosen, descriptions = {}) {
    this.chosen = chosen;
    this.descriptions = descriptions;
    this.fields = h("div", { class: "lengths" });
    this.element = h(
      "details",
      { class: "symbols-more", hidden: true },
      h("summary", {}, worded("Lengths and other symbols")),
      this.fields,
    );
  }

  /** @param {Record<string, number>} symbols */
  show(symbols) {
    const names = Object.keys(symbols);
    this.element.hidden = names.length === 0;
    if (this.fields.dataset.names !== names.join(" ")) {
      this.fields.dataset.names = names.join(" ");
      this.fields.replaceChildren(...names.map((name) => this.#field(name)));
    }
    for (const field of this.fields.querySelectorAll("input")) {
      if (!field.matches(":focus")) field.value = decimal(symbols[field.name]);
    }
  }

  /** @param {string} name */
  #field(name) {
    const described = this.descriptions[name] && visible(this.descriptions[name]);
    const changed = (/** @type {{ target: HTMLInputElement }} */ { target: { valueAsNumber: value } }) =>
      Number.isFinite(value) && Math.abs(value) <= LARGEST && this.chosen(name, value);
    const field = h("input", {
      type: "number",
      step: 0.05,
      name,
      oninput: changed,
      "aria-label": described ? `${name}: ${described}` : name,
    });
    return h(
      "label",
      { title: described ?? null },
      h("span", { class: "name", "aria-hidden": "true" }, symbolName(name)),
      field,
    );
  }
}

/** Checkboxes that show or hide each frame of the table. */
export class FrameSwitches {
  /** @type {Set<number>} */
  #hidden = new Set();

  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
    this.element = h("div", { class: "frames", role: "group", "aria-label": worded("Frames shown") });
  }

  /** @param {number} i */
  isShown(i) {
    return !this.#hidden.has(i);
  }

  showAll() {
    this.#hidden.clear();
  }

  /** @param {number} count */
  show(count) {
    if (this.element.children.length === (count ? count + 1 : 0)) return;
    /** @type {(i: number, on: boolean) => void} */
    const toggle = (i, on) => (on ? this.#hidden.delete(i) : this.#hidden.add(i), this.changed());
    const boxes = Array.from({ length: count }, (_, i) => {
      const box = h("input", {
        type: "checkbox",
        checked: this.isShown(i),
        "aria-label": worded("Show frame {frame}", { frame: i }),
        onchange: (event) => toggle(i, event.target.checked),
      });
      return h("label", {}, box, ` {${i}}`);
    });
    const legend = h(
      "span",
      { class: "legend" },
      worded("Frames"),
      " ",
      ...["x", "y", "z"].map((axis) => h("i", { class: axis }, axis)),
    );
    this.element.replaceChildren(...(count ? [legend, ...boxes] : []));
  }
}

/** The coordinates of the tool and of the last frame. */
export class PoseNumbers {
  constructor() {
    this.element = h("div", { class: "pose-numbers" });
  }

  /** @param {Front.Picture} picture @param {Front.Gap | null} gap */
  show({ frames, mechanism }, gap) {
    /** @type {[string, number[] | string][]} */
    const lines = [];
    const last = frames && frames.length - 1;
    if (mechanism) lines.push([worded("Tool of the robot"), mechanism.tool]);
    if (last && last > 0) {
      lines.push([worded("Origin of your frame {frame}", { frame: `{${last}}` }), column(frames[last], 3)]);
    }
    if (gap) lines.push([worded("Gap to the tool frame"), isClosed(gap) ? worded("none") : gapText(gap)]);
    if (this.element.children.length !== lines.length) {
      this.element.replaceChildren(...lines.map(() => h("p", {}, h("span"), h("code"))));
    }
    lines.forEach(([name, shown], i) => {
      const [label, value] = this.element.children[i].children;
      label.textContent = name;
      value.textContent = typeof shown === "string" ? shown : shown.map(decimal).join("  ");
    });
  }
}
