// The labels of the 3D view: texts that face the viewer, with a fixed size in pixels. One call draws all
// of them, from one texture that holds each text once.

import {
  CanvasTexture,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  Object3D,
  PlaneGeometry,
  ShaderMaterial,
  Vector2,
  Vector3,
} from "../vendor/three-0.185.1.module.min.js";
import { takePlace } from "./frames/label_places.js";

// The height of a text in the texture in pixels, and the share of it that letters fill.
const LINE = 48;
const LETTERS = 0.72;
const HALO = 6;
const FONT = `600 ${LETTERS * LINE}px system-ui, "DejaVu Sans", sans-serif`;
const VERTEX = `
  attribute vec3 place; attribute vec4 piece; attribute vec4 box;
  uniform vec2 stage; varying vec2 at;
  void main() {
    at = piece.xy + uv * piece.zw;
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
    gl_Position.xy += (uv - box.zw) * box.xy * 2.0 / stage * gl_Position.w;
  }`;
const FRAGMENT = `
  uniform sampler2D texts; varying vec2 at;
  void main() { gl_FragColor = texture2D(texts, at); }`;

/**
 * A text in the texture, with its ratio of width to height, and the piece of the texture that the text fills.
 *
 * @typedef {{ text: string, colour: keyof Front.Palette, ratio: number, piece: [number, number, number, number] }} Written
 */

/** All labels of a scene, with the methods of a `Batch` of shapes. */
export class Labels {
  /** @type {Map<string, Written>} */
  #texts = new Map();
  #parts = 0;
  #count = 0;
  /** @type {ReturnType<Labels["make"]> | null} */
  #mesh = null;

  /**
   * `stage` holds the size of the stage in pixels.
   *
   * @param {Front.Palette} palette
   * @param {Vector2} stage
   * @param {Front.Camera} camera
   */
  constructor(palette, stage, camera) {
    this.palette = palette;
    this.stage = stage;
    this.camera = camera;
    /** @type {Front.LabelRoom[]} */
    this.taken = [];
  }

  /**
   * Return a part with a text that is `height` pixels high. The part's position is at the text's `centre`, which is
   * given as shares of the text's size from its lower left corner.
   *
   * @param {string} text
   * @param {keyof Front.Palette} colour
   * @param {number} height
   */
  part(text, colour, height) {
    this.#parts += 1;
    const key = `${text} ${colour}`;
    if (!this.#texts.has(key)) this.#texts.set(key, { text, colour, ratio: 1, piece: [0, 0, 1, 1] });
    const part = new Object3D();
    part.userData = { batch: this, text: this.#texts.get(key), height, centre: new Vector2(0.5, 0.5) };
    return part;
  }

  /** @param {Front.LabelRoom[]} taken is the room of other texts in the stage. */
  begin(taken = []) {
    this.#count = 0;
    this.taken = [...taken];
  }

  /**
   * Draw a label next to its place, but not over earlier labels; leave it out if there is no room.
   *
   * @param {Object3D} part
   */
  add({ matrixWorld, userData: { text, height, centre: wanted } }) {
    const { place, piece, box } = this.mesh.geometry.attributes;
    const [x, y, z] = matrixWorld.elements.slice(12, 15);
    const at = new Vector3(x, y, z).project(this.camera);
    const pixels = { x: ((at.x + 1) / 2) * this.stage.x, y: ((at.y + 1) / 2) * this.stage.y };
    const [across, up] =
      takePlace({ ...pixels, width: height * text.ratio, height, centre: [wanted.x, wanted.y] }, this.taken) ?? [];
    if (across === undefined || up === undefined) return;
    place.setXYZ(this.#count, x, y, z);
    piece.setXYZW(this.#count, .../** @type {Written} */ (text).piece);
    box.setXYZW(this.#count, height * text.ratio, height, across, up);
    this.#count += 1;
  }

  end() {
    const { geometry } = this.mesh;
    geometry.instanceCount = this.#count;
    for (const name of ["place", "piece", "box"]) geometry.attributes[name].needsUpdate = true;
  }

  /** The mesh that draws all labels added so far. */
  get mesh() {
    return (this.#mesh ??= this.make());
  }

  make() {
    const geometry = new InstancedBufferGeometry();
    const { index, attributes } = new PlaneGeometry(1, 1);
    geometry.setIndex(index);
    geometry.setAttribute("position", attributes.position);
    geometry.setAttribute("uv", attributes.uv);
    for (const [name, size] of Object.entries({ place: 3, piece: 4, box: 4 })) {
      geometry.setAttribute(name, new InstancedBufferAttribute(new Float32Array(size * this.#parts), size));
    }
    const texts = new CanvasTexture(this.#written());
    // Otherwise the halo would mix with the black of transparent pixels.
    texts.premultiplyAlpha = true;
    const uniforms = { texts: { value: texts }, stage: { value: this.stage } };
    const drawn = {
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      depthTest: false,
      transparent: true,
      premultipliedAlpha: true,
    };
    const material = new ShaderMaterial({ uniforms, ...drawn });
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
    return mesh;
  }

  /** Return the texture with all texts, one below the other. */
  #written() {
    const canvas = document.createElement("canvas");
    const texts = [...this.#texts.values()];
    const context = canvas.getContext("2d");
    if (!context) return canvas;
    context.font = FONT;
    const widths = texts.map(({ text }) => Math.ceil(context.measureText(text).width + 0.2 * LINE));
    // A new size resets the context.
    canvas.width = Math.max(...widths);
    canvas.height = LINE * texts.length;
    Object.assign(context, {
      font: FONT,
      textAlign: "center",
      textBaseline: "middle",
      lineJoin: "round",
      lineWidth: HALO,
    });
    context.strokeStyle = this.palette.paper;
    texts.forEach((each, i) => {
      const colour = this.palette[each.colour];
      context.fillStyle = typeof colour === "number" ? `#${colour.toString(16).padStart(6, "0")}` : colour;
      const [x, y] = [widths[i] / 2, (i + 0.5) * LINE];
      context.strokeText(each.text, x, y);
      context.fillText(each.text, x, y);
      each.ratio = widths[i] / LINE;
      each.piece = [0, 1 - (i + 1) / texts.length, widths[i] / canvas.width, 1 / texts.length];
    });
    return canvas;
  }

  dispose() {
    if (!this.#mesh) return;
    this.#mesh.removeFromParent();
    this.#mesh.geometry.dispose();
    this.#mesh.material.uniforms.texts.value.dispose();
    this.#mesh.material.dispose();
  }
}
