// What the 3D view is made of: rods, joints, frames and labels, from shared shapes of size 1.

import {
  BoxGeometry, CanvasTexture, ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, MeshLambertMaterial,
  SphereGeometry, Sprite, SpriteMaterial, SRGBColorSpace, Vector3,
} from "./three-0.185.1.module.min.js";

const UP = new Vector3(0, 1, 0);
const SHAPES = {
  cylinder: new CylinderGeometry(1, 1, 1, 32),
  thin: new CylinderGeometry(1, 1, 1, 10),
  cone: new ConeGeometry(1, 1, 14),
  box: new BoxGeometry(1, 1, 1),
  sphere: new SphereGeometry(1, 16, 12),
};

export const vector = (numbers) => new Vector3(...numbers);

export class Shapes {
  #materials = new Map();
  #labels = new Map();

  constructor(palette) {
    this.palette = palette;
  }

  #material(name, flat) {
    const key = `${name} ${flat}`;
    if (!this.#materials.has(key)) {
      const Kind = flat ? MeshBasicMaterial : MeshLambertMaterial;
      this.#materials.set(key, new Kind({ color: this.palette[name] }));
    }
    return this.#materials.get(key);
  }

  mesh(shape, colour, flat = false) {
    return new Mesh(SHAPES[shape], this.#material(colour, flat));
  }

  /** A rod along `count` corners, with round elbows. */
  rods(count, colour, flat = false) {
    const group = new Group();
    for (let i = 0; i < count; i++) {
      if (i) group.add(this.mesh("thin", colour, flat));
      group.add(this.mesh("sphere", colour, flat));
    }
    return group;
  }

  /** Three arrows from the origin: x red, y green, z blue, each with its letter. */
  frame(length) {
    const group = new Group();
    for (const [name, axis] of Object.entries({ x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] })) {
      const direction = vector(axis);
      const shaft = this.mesh("thin", name, true);
      lay(shaft, new Vector3(), direction.clone().multiplyScalar(0.82 * length), 0.022 * length);
      const head = this.mesh("cone", name, true);
      head.quaternion.setFromUnitVectors(UP, direction);
      head.position.copy(direction).multiplyScalar(0.9 * length);
      head.scale.set(0.065 * length, 0.2 * length, 0.065 * length);
      const letter = this.label(name, name, 13);
      letter.position.copy(direction).multiplyScalar(1.16 * length);
      group.add(shaft, head, letter);
    }
    group.matrixAutoUpdate = false;
    return group;
  }

  /** A text that faces the viewer, `height` pixels high. */
  label(text, colour, height) {
    const key = `${text} ${colour}`;
    if (!this.#labels.has(key)) this.#labels.set(key, written(text, this.palette[colour], this.palette.paper));
    const { material, ratio } = this.#labels.get(key);
    const sprite = new Sprite(material);
    sprite.userData = { height, ratio };
    sprite.renderOrder = 1;
    return sprite;
  }

  dispose() {
    for (const material of this.#materials.values()) material.dispose();
    for (const { material } of this.#labels.values()) {
      material.map.dispose();
      material.dispose();
    }
  }
}

function written(text, colour, halo) {
  const canvas = document.createElement("canvas");
  const size = 48;
  const font = `600 ${0.72 * size}px system-ui, "DejaVu Sans", sans-serif`;
  let context = canvas.getContext("2d");
  context.font = font;
  canvas.width = Math.ceil(context.measureText(text).width + 0.2 * size);
  canvas.height = size;
  context = canvas.getContext("2d");
  Object.assign(context, { font, textAlign: "center", textBaseline: "middle", lineJoin: "round", lineWidth: 6 });
  context.strokeStyle = halo;
  context.fillStyle = typeof colour === "number" ? `#${colour.toString(16).padStart(6, "0")}` : colour;
  context.strokeText(text, canvas.width / 2, size / 2);
  context.fillText(text, canvas.width / 2, size / 2);
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  return { material: new SpriteMaterial({ map, depthTest: false, transparent: true }), ratio: canvas.width / size };
}

/** Lay a mesh whose shape is along y from one point to another. */
export function lay(mesh, from, to, radius) {
  const step = to.clone().sub(from);
  const length = step.length();
  mesh.visible = length > 1e-9;
  if (!mesh.visible) return;
  mesh.position.copy(from).addScaledVector(step, 0.5);
  mesh.quaternion.setFromUnitVectors(UP, step.divideScalar(length));
  mesh.scale.set(radius, length, radius);
}

/** Lay the rods of `Shapes.rods` along corners. */
export function layRods(group, corners, radius) {
  const points = corners.map(vector);
  points.forEach((point, i) => {
    const sphere = group.children[2 * i];
    sphere.position.copy(point);
    sphere.scale.setScalar(radius);
    if (i) lay(group.children[2 * i - 1], points[i - 1], point, radius);
  });
}
