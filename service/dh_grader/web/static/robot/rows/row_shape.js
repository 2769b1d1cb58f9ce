// A row in the 3D view: its ghost frame, the lines and arcs of its moves, and the gap at its end.

import { Group } from "../../vendor/three-0.185.1.module.min.js";
import { GapShape } from "../frames/given_shapes.js";
import { StageText } from "../frames/stage_text.js";
import { column } from "../motion.js";
import { layRods, vector } from "../shapes.js";
import { frameAt } from "./row_moves.js";

const PIECES = 24;
const FULL = 2 * Math.PI;
const SMALL = 1e-9;

export class RowShape {
  /** @param {Front.Shapes} shapes @param {number} size @param {HTMLElement} stage */
  constructor(shapes, size, stage) {
    this.size = size;
    this.group = new Group();
    this.ghost = shapes.frame(0.27 * size);
    this.origin = shapes.mesh("sphere", "chain", true);
    this.lines = { x: shapes.rods(2, "x", true), z: shapes.rods(2, "z", true) };
    this.arcs = { x: shapes.rods(PIECES + 1, "x", true), z: shapes.rods(PIECES + 1, "z", true) };
    this.gap = new GapShape(shapes, size, stage, "row-gap");
    this.text = new StageText(stage, "measure");
    this.moves = new Group();
    this.moves.add(...Object.values(this.lines), ...Object.values(this.arcs));
    this.group.add(this.ghost, this.origin, this.moves, this.gap.group);
  }

  /**
   * Show a row; null hides it. `aside` is the offset of the table from the robot.
   *
   * @param {Front.ShownRow | null} row
   * @param {Front.Vector3} aside
   */
  put(row, aside) {
    this.group.visible = row !== null;
    this.group.position.copy(aside);
    this.gap.put(aside.length() ? null : row?.gap ?? null);
    if (!row) return this.text.put("");
    for (const part of this.moves.children) part.visible = false;
    row.moves.forEach((_, i) => this.#put(row, i));
    const [[a, b, c, x], [d, e, f, y], [g, k, l, z]] = frameAt(row.start, row.moves, row.at);
    this.ghost.visible = this.origin.visible = !row.isLit;
    this.ghost.matrix.set(a, b, c, x, d, e, f, y, g, k, l, z, 0, 0, 0, 1);
    this.ghost.matrixWorldNeedsUpdate = true;
    this.origin.position.set(x, y, z);
    this.origin.scale.setScalar(0.022 * this.size);
    const [text, point] = row.text && this.middle ? [row.text, this.middle.add(aside)] : [""];
    return this.text.put(text, point);
  }

  /**
   * Draw the part of move `i` that is done. The current move is thick. For a highlighted cell, draw only its own move.
   *
   * @param {Front.ShownRow} row
   * @param {number} i
   */
  #put({ start, moves, at, current, isLit }, i) {
    const { axis, turns, amount } = moves[i];
    if (i === current) this.middle = vector(column(frameAt(start, moves, i), 3));
    const share = Math.max(0, Math.min(1, at - i));
    if (Math.abs(share * amount) < SMALL || (isLit && i !== current)) return;
    const before = frameAt(start, moves, i);
    const from = column(before, 3);
    const corners = turns
      ? arc(before, axis, share * amount, 0.2 * this.size)
      : [from, column(frameAt(start, moves, i + share), 3)];
    const part = turns ? this.arcs[axis] : this.lines[axis];
    part.visible = true;
    layRods(part, corners, (i === current ? 0.012 : 0.005) * this.size);
    if (i !== current) return;
    this.middle = turns ? vector(corners[PIECES / 2]) : vector(corners[0]).add(vector(corners[1])).multiplyScalar(0.5);
  }

  get texts() {
    return [this.gap.text, this.text];
  }

  dispose() {
    this.gap.dispose();
    this.text.dispose();
  }
}

/**
 * Return the corners of an arc about an axis of a frame. It begins at x if the axis is z, and at z if the axis is x.
 *
 * @param {Front.Frame} frame
 * @param {"x" | "z"} axis
 * @param {number} angle
 * @param {number} radius
 */
function arc(frame, axis, angle, radius) {
  const [x, y, z, origin] = [0, 1, 2, 3].map((j) => column(frame, j));
  // About x, z turns towards −y.
  const [from, towards] = axis === "z" ? [x, y] : [z, y.map((value) => -value)];
  const drawn = Math.max(-FULL, Math.min(FULL, angle));
  return Array.from({ length: PIECES + 1 }, (_, k) => {
    const [cosine, sine] = [Math.cos, Math.sin].map((of) => radius * of((k / PIECES) * drawn));
    return origin.map((value, i) => value + cosine * from[i] + sine * towards[i]);
  });
}
