// The two robots in the 3D view: the mechanism of an exercise, drawn as in its figure, and the chain of a
// table. The pictures of `motion.js` move both.

import { Group, Vector3 } from "../vendor/three-0.185.1.module.min.js";
import { column, dot } from "./motion.js";
import { lay, layRods, vector } from "./shapes.js";

// Sizes as shares of the mechanism's size, as in service/dh_grader/figures/mechanism.py.
const JOINT_LENGTH = 0.15;
const JOINT_RADIUS = 0.046;
const ROD = 0.018;
const GRIPPER = 0.09;
const UP = new Vector3(0, 1, 0);

/** A joint on its axis: a cylinder turns, a box slides. */
class JointShape {
  /** @param {Front.Shapes} shapes @param {boolean} slides @param {number} size */
  constructor(shapes, slides, size) {
    this.size = size;
    this.slides = slides;
    this.body = shapes.mesh(slides ? "box" : "cylinder", slides ? "sliding" : "turning");
    this.line = shapes.mesh("thin", "axis", true);
    this.group = new Group();
    this.group.add(this.body, this.line);
  }

  /** @param {number[]} centre @param {number[]} axis */
  put(centre, axis) {
    const { size } = this;
    const at = vector(centre);
    const direction = vector(axis);
    /** @type {(share: number) => Vector3} */
    const along = (share) => at.clone().addScaledVector(direction, share * size);
    const width = (this.slides ? 2.1 : 1) * JOINT_RADIUS * size;
    lay(this.body, along(-JOINT_LENGTH / 2), along(JOINT_LENGTH / 2), width);
    lay(this.line, along(-0.26), along(0.26), 0.0035 * size);
  }
}

export class MechanismShape {
  /**
   * @param {Front.Shapes} shapes
   * @param {Api.JointKind[]} kinds
   * @param {number} size
   * @param {Api.DrawnConfiguration} first
   */
  constructor(shapes, kinds, size, first) {
    this.size = size;
    this.group = new Group();
    this.joints = kinds.map((kind) => new JointShape(shapes, kind === "P", size));
    this.links = first.links.map((link) => shapes.rods(link.length, "rod"));
    /** @param {Front.Shapes} shapes @param {number} size */
    this.gripper = gripper(shapes, size);
    this.group.add(...this.joints.map((joint) => joint.group), ...this.links, this.gripper);
    this.group.add(ground(shapes, size, vector(first.base), vector(first.base_normal)));
  }

  /** @param {Api.DrawnConfiguration} shown */
  put(shown) {
    this.joints.forEach((joint, i) => joint.put(shown.centres[i], shown.axes[i]));
    const last = this.links.length - 1;
    const tip = vector(shown.tool).addScaledVector(vector(shown.tool_direction), -GRIPPER * this.size);
    this.links.forEach((link, i) => {
      const corners = i < last ? shown.links[i] : [...shown.links[i].slice(0, -1), tip.toArray()];
      layRods(link, corners, ROD * this.size);
    });
    this.gripper.position.copy(tip);
    this.gripper.quaternion.setFromUnitVectors(UP, vector(shown.tool_direction));
  }
}

/** @param {Front.Shapes} shapes @param {number} size */
function gripper(shapes, size) {
  const group = new Group();
  const reach = GRIPPER * size;
  /** @type {(x: number, y: number, width: number, height: number) => void} */
  const part = (x, y, width, height) => {
    const box = shapes.mesh("box", "grip");
    box.position.set(x * reach, y * reach, 0);
    box.scale.set(width * reach, height * reach, 0.26 * reach);
    group.add(box);
  };
  part(0, 0.3, 1.1, 0.2);
  part(-0.45, 0.65, 0.2, 0.7);
  part(0.45, 0.65, 0.2, 0.7);
  return group;
}

/** @param {Front.Shapes} shapes @param {number} size @param {Vector3} base @param {Vector3} normal */
function ground(shapes, size, base, normal) {
  const plate = shapes.mesh("cylinder", "ground");
  lay(plate, base.clone().addScaledVector(normal, -0.03 * size), base, 0.17 * size);
  return plate;
}

/**
 * The chain of a table: a robot of its own if it is `solid`, otherwise lines over another robot. `kinds` has the kind
 * of joint of each row, or null for a fixed row.
 */
export class ChainShape {
  /**
   * @param {Front.Shapes} shapes
   * @param {(Api.JointKind | null)[]} kinds
   * @param {Api.Convention} convention
   * @param {number} size
   * @param {number} count
   * @param {boolean} solid
   */
  constructor(shapes, kinds, convention, size, count, solid) {
    this.size = size;
    this.convention = convention;
    this.group = new Group();
    this.lines = Array.from({ length: count - 1 }, () => shapes.rods(3, solid ? "rod" : "chain", !solid));
    this.joints = solid
      ? kinds.slice(0, count - 1).map((kind) => kind && new JointShape(shapes, kind === "P", size))
      : [];
    this.radius = (solid ? ROD : 0.007) * size;
    this.group.add(...this.lines, ...this.joints.flatMap((joint) => joint?.group ?? []));
    if (solid) this.group.add(ground(shapes, size, new Vector3(0, 0, 0), new Vector3(0, 0, 1)));
  }

  /** @param {Front.Frame[]} frames */
  put(frames) {
    this.lines.forEach((line, i) => layRods(line, linkOf(frames[i], frames[i + 1], this.convention), this.radius));
    this.joints.forEach((joint, i) => {
      const on = this.convention === "modified" ? frames[i + 1] : frames[i];
      joint?.put(column(on, 3), column(on, 2));
    });
  }
}

/**
 * Return the corners of the line from one frame to the next: along z and x, in the order of the convention.
 *
 * @param {Front.Frame} from
 * @param {Front.Frame} to
 * @param {Api.Convention} convention
 */
function linkOf(from, to, convention) {
  const [start, end] = [column(from, 3), column(to, 3)];
  const first = column(from, convention === "modified" ? 0 : 2);
  const far = dot(first, end) - dot(first, start);
  return [start, start.map((value, i) => value + far * first[i]), end];
}

/** The frames of a table, or those that the student placed, with their names. */
export class FramesShape {
  /** @param {Front.Shapes} shapes @param {string[]} names @param {number} length */
  constructor(shapes, names, length) {
    this.length = length;
    this.group = new Group();
    this.frames = names.map(() => shapes.frame(length));
    this.labels = names.map((name) => shapes.label(`{${name}}`, "ink", 18));
    this.group.add(...this.frames, ...this.labels);
  }

  /** @param {Front.Frame[]} frames @param {(i: number) => boolean} shown */
  put(frames, shown) {
    /** @type {Vector3[]} */
    const taken = [];
    frames.slice(0, this.frames.length).forEach((frame, i) => {
      this.frames[i].visible = this.labels[i].visible = shown(i);
      if (!shown(i)) return;
      const [[a, b, c, x], [d, e, f, y], [g, k, l, z]] = frame;
      this.frames[i].matrix.set(a, b, c, x, d, e, f, y, g, k, l, z, 0, 0, 0, 1);
      this.frames[i].matrixWorldNeedsUpdate = true;
      const origin = new Vector3(x, y, z);
      // If several frames are at one place, their names are side by side.
      const before = taken.filter((other) => other.distanceTo(origin) < 0.05 * this.length).length;
      taken.push(origin);
      this.labels[i].position.copy(origin);
      this.labels[i].userData.centre.set(0.5 - 0.95 * before, 1.45);
    });
  }
}
