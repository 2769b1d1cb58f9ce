// The parts of the 3D view: rods, joints, frames and labels, made of shared shapes of size 1. A part is a
// place in the scene. All parts of a shape are drawn in one call, because draw calls take the most time.

import {
  BoxGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Group,
  InstancedMesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Object3D,
  SphereGeometry,
  Vector3,
} from "../vendor/three-0.185.1.module.min.js";
import { Labels } from "./labels.js";

const UP = new Vector3(0, 1, 0);
/** @type {["x" | "y" | "z", number[]][]} */
const AXES = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];
/** Where the names of a frame's axes are, as a share of the length of the axes. */
export const NAMES = 1.16;
const SHAPES = {
  cylinder: new CylinderGeometry(1, 1, 1, 28),
  thin: new CylinderGeometry(1, 1, 1, 8),
  cone: new ConeGeometry(1, 1, 10),
  box: new BoxGeometry(1, 1, 1),
  sphere: new SphereGeometry(1, 12, 8),
};

/** @param {number[]} numbers */
export const vector = (numbers) => new Vector3(...numbers);

/** All parts of one shape; each has its own colour. */
class Batch {
  #parts = 0;
  /** @type {InstancedMesh | null} */
  #mesh = null;
  #count = 0;

  /** @param {keyof typeof SHAPES} shape @param {boolean} flat */
  constructor(shape, flat) {
    this.geometry = SHAPES[shape];
    this.material = flat ? new MeshBasicMaterial() : new MeshLambertMaterial();
  }

  /** @param {string | number} colour */
  part(colour) {
    this.#parts += 1;
    const part = new Object3D();
    part.userData = { batch: this, colour: new Color(colour) };
    return part;
  }

  begin() {
    this.#count = 0;
  }

  /** @param {Object3D} part */
  add({ matrixWorld, userData: { colour } }) {
    this.mesh.setMatrixAt(this.#count, matrixWorld);
    this.mesh.setColorAt(this.#count, colour);
    this.#count += 1;
  }

  end() {
    const { mesh } = this;
    mesh.count = this.#count;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }

  /** The mesh that draws all parts added so far. */
  get mesh() {
    if (!this.#mesh) {
      this.#mesh = new InstancedMesh(this.geometry, this.material, this.#parts);
      this.#mesh.frustumCulled = false;
    }
    return this.#mesh;
  }

  dispose() {
    this.#mesh?.removeFromParent();
    this.#mesh?.dispose();
    this.material.dispose();
  }
}

/** The parts of one scene. */
export class Shapes {
  /** @type {Map<string, Batch>} */
  #batches = new Map();
  /** @type {Labels | null} */
  #labels = null;

  /**
   * `stage` holds the size of the stage in pixels.
   *
   * @param {Front.Palette} palette
   * @param {Front.Scene} scene
   * @param {Front.Vector2} stage
   * @param {Front.Camera} camera
   */
  constructor(palette, scene, stage, camera) {
    this.palette = palette;
    this.scene = scene;
    this.stage = stage;
    this.camera = camera;
  }

  /** @param {keyof typeof SHAPES} shape @param {keyof Front.Palette} colour @param {boolean} [flat] */
  mesh(shape, colour, flat = false) {
    const key = `${shape} ${flat}`;
    const batch = this.#batches.get(key) ?? new Batch(shape, flat);
    this.#batches.set(key, batch);
    return batch.part(this.palette[colour]);
  }

  get #all() {
    return [...this.#batches.values(), ...(this.#labels ? [this.#labels] : [])];
  }

  /** Add all batches to the scene, after the last part was created. */
  finish() {
    for (const batch of this.#all) this.scene.add(batch.mesh);
  }

  /**
   * Update the drawn position of each visible part.
   *
   * @param {Front.LabelRoom[]} [taken] is the room that labels must avoid
   */
  put(taken) {
    for (const batch of this.#all) batch.begin(taken);
    this.scene.updateMatrixWorld();
    this.scene.traverseVisible((each) => each.userData.batch?.add(each));
    for (const batch of this.#all) batch.end();
  }

  /**
   * Return a group of rods that join `count` corners, with a sphere at each corner.
   *
   * @param {number} count
   * @param {keyof Front.Palette} colour
   * @param {boolean} [flat]
   */
  rods(count, colour, flat = false) {
    const group = new Group();
    for (let i = 0; i < count; i++) {
      if (i) group.add(this.mesh("thin", colour, flat));
      group.add(this.mesh("sphere", colour, flat));
    }
    return group;
  }

  /**
   * Return three arrows from the origin, each with its letter: x red, y green, z blue.
   *
   * If `index` is given, the arrows are thin and pale, and x and z have letters with this index.
   *
   * @param {number} length
   * @param {string | null} [index]
   */
  frame(length, index = null) {
    const isGhost = index !== null;
    const thin = isGhost ? 0.55 : 1;
    const group = new Group();
    for (const [name, axis] of AXES) {
      const direction = vector(axis);
      /** @type {keyof Front.Palette} */
      const colour = isGhost ? `${name}Pale` : name;
      const shaft = this.mesh("thin", colour, true);
      lay(shaft, new Vector3(), direction.clone().multiplyScalar(0.82 * length), 0.022 * thin * length);
      const head = this.mesh("cone", colour, true);
      head.quaternion.setFromUnitVectors(UP, direction);
      head.position.copy(direction).multiplyScalar(0.9 * length);
      head.scale.set(0.065 * thin * length, 0.2 * length, 0.065 * thin * length);
      group.add(shaft, head);
      if (isGhost && name === "y") continue;
      const letter = this.label(name + (index ?? ""), isGhost ? "quiet" : name, 17);
      letter.position.copy(direction).multiplyScalar(NAMES * length);
      group.add(letter);
    }
    group.matrixAutoUpdate = false;
    return group;
  }

  /** @param {string} text @param {keyof Front.Palette} colour @param {number} height */
  label(text, colour, height) {
    this.#labels ??= new Labels(this.palette, this.stage, this.camera);
    return this.#labels.part(text, colour, height);
  }

  dispose() {
    for (const batch of this.#all) batch.dispose();
  }
}

/**
 * Place a mesh whose shape is along y between two points.
 *
 * @param {Object3D} mesh
 * @param {Vector3} from
 * @param {Vector3} to
 * @param {number} radius
 */
export function lay(mesh, from, to, radius) {
  const step = to.clone().sub(from);
  const length = step.length();
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  mesh.position.copy(from).addScaledVector(step, 0.5);
  mesh.quaternion.setFromUnitVectors(UP, step.divideScalar(length));
  mesh.scale.set(radius, length, radius);
}

/**
 * Place the rods of `Shapes.rods` along corners.
 *
 * @param {Group} group
 * @param {number[][]} corners
 * @param {number} radius
 */
export function layRods(group, corners, radius) {
  const points = corners.map(vector);
  points.forEach((point, i) => {
    const sphere = group.children[2 * i];
    sphere.position.copy(point);
    sphere.scale.setScalar(radius);
    if (i) lay(group.children[2 * i - 1], points[i - 1], point, radius);
  });
}
