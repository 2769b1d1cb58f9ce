// The frames that the exercise gives, drawn thin and pale in the 3D view, and the gap to the given tool frame.

import { Group } from "../../vendor/three-0.185.1.module.min.js";
import { lay, vector } from "../shapes.js";
import { gapText, isClosed } from "./gap.js";
import { StageText } from "./stage_text.js";

/** @type {Record<string, string>} */
const LOWERED = { e: "ₑ", s: "ₛ", ...Object.fromEntries([..."₀₁₂₃₄₅₆₇₈₉"].map((digit, i) => [i, digit])) };

/** @param {string} label */
const lowered = (label) => [...label].map((letter) => LOWERED[letter] ?? letter).join("");

/** The given frames, each with its name, x and z. */
export class GhostFrames {
  /** @param {Front.Shapes} shapes @param {string[]} labels @param {number} length */
  constructor(shapes, labels, length) {
    this.group = new Group();
    this.frames = labels.map((label) => shapes.frame(length, lowered(label)));
    this.names = labels.map((label) => shapes.label(`{${label}}`, "quiet", 18));
    this.group.add(...this.frames, ...this.names);
  }

  /** @param {Front.Frame[]} frames */
  put(frames) {
    frames.forEach(([[a, b, c, x], [d, e, f, y], [g, k, l, z]], i) => {
      this.frames[i].matrix.set(a, b, c, x, d, e, f, y, g, k, l, z, 0, 0, 0, 1);
      this.frames[i].matrixWorldNeedsUpdate = true;
      this.names[i].position.set(x, y, z);
      this.names[i].userData.centre.set(1.15, 1.15);
    });
  }
}

/** The vector from the last frame of a table to the tool frame, with its length and the angle between the frames. */
export class GapShape {
  /** @param {Front.Shapes} shapes @param {number} size @param {HTMLElement} stage @param {string} [name] of its class */
  constructor(shapes, size, stage, name = "gap") {
    this.size = size;
    this.line = shapes.mesh("thin", "gap", true);
    this.group = new Group();
    this.group.add(this.line);
    this.text = new StageText(stage, name);
  }

  /** @param {Front.Gap | null} gap */
  put(gap) {
    this.group.visible = Boolean(gap && !isClosed(gap));
    if (!gap || !this.group.visible) return this.text.put("");
    const [from, to] = [vector(gap.from), vector(gap.to)];
    lay(this.line, from, to, 0.008 * this.size);
    return this.text.put(gapText(gap), from.add(to).multiplyScalar(0.5));
  }

  dispose() {
    this.text.dispose();
  }
}
