// The 3D scene and its orbiting camera. It is only redrawn after a change.

import {
  Color,
  DirectionalLight,
  HemisphereLight,
  MOUSE,
  PerspectiveCamera,
  Scene,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "../vendor/three-0.185.1.module.min.js";
import { OrbitControls } from "../vendor/three-0.185.1.orbit-controls.js";
import { GapShape, GhostFrames } from "./frames/given_shapes.js";
import { column } from "./motion.js";
import { paletteOf } from "./palette.js";
import { ChainShape, FramesShape, MechanismShape } from "./robot_shapes.js";
import { NAMES, Shapes, vector } from "./shapes.js";

const FIELD_OF_VIEW = 28;
const STEEPEST = 1.55;
// The length of the axes of given frames, as a share of the size.
const GHOST = 0.26;
// Half the width of the name of an axis (pixels), which also has some space around it.
const LETTERS = 14;
// Half the length of a joint axis for clicks, as a share of the size.
const AXIS = 0.3;
// Without a graphics card, the scene is drawn coarsely while something moves, and finely after this many
// milliseconds of rest.
const AT_REST = 200;
const FINE = 2;

export class RobotScene {
  // The first call of `show` sets `#picture` and `#subject`.
  /** @type {Front.Picture} */
  #picture;
  /** @type {Front.Subject} */
  #subject;
  #asked = 0;
  #fitted = false;
  // True unless the user has moved a point out of the picture.
  #wasInside = true;
  // The offset of a table's chain from the robot, if they are shown side by side.
  aside = new Vector3();
  // Called after each picture.
  drawn = () => {};

  /**
   * The canvas fills the element `stage`. `inSoftware` is true if the browser draws without a graphics card.
   *
   * @param {HTMLElement} stage
   * @param {boolean} [inSoftware]
   */
  constructor(stage, inSoftware = false) {
    this.stage = stage;
    // Until the size of the stage is known.
    this.size = new Vector2(400, 400);
    this.inSoftware = inSoftware;
    this.renderer = new WebGLRenderer({ antialias: !inSoftware, alpha: true });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.autoClear = false;
    this.canvas = this.renderer.domElement;
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    const lamp = new DirectionalLight(new Color(1, 1, 1), 2.1);
    lamp.position.set(0.5, 1, 0.6);
    this.camera.add(lamp);
    // Lines and labels are drawn over the solids, even if they are farther away.
    this.solids = new Scene();
    this.over = new Scene();
    this.solids.add(this.camera, new HemisphereLight(0xffffff, 0x8890a0, 1.9));
    stage.append(this.canvas);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.mouseButtons.MIDDLE = MOUSE.PAN;
    // The wheel scrolls the page until the user has clicked the view.
    this.controls.enableZoom = false;
    this.canvas.addEventListener("pointerdown", () => (this.controls.enableZoom = true), { capture: true });
    this.canvas.addEventListener("focusout", () => (this.controls.enableZoom = false));
    this.controls.addEventListener("change", () => {
      if (this.#fitted) this.#wasInside = this.#isInside();
      this.draw();
    });
    this.resizing = new ResizeObserver(() => this.#resize());
    this.resizing.observe(stage);
    this.stop = new AbortController();
    const recolour = () => this.recolour();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour, { signal: this.stop.signal });
    this.themes = new MutationObserver(recolour);
    this.themes.observe(document.documentElement, { attributes: true });
    this.canvas.addEventListener("webglcontextrestored", () => this.draw());
  }

  /**
   * Draw a subject: `{kinds, rowKinds, convention, size, azimuth, elevation, solid, beside, shown, robot, labels, given,
   * placed, shownPlaced, gap, row, shownRow}`.
   *
   * @param {Front.Subject} subject
   * @param {Front.Picture} picture
   */
  show(subject, picture) {
    this.#subject = subject;
    this.#picture = picture;
    this.#build();
    if (!this.#fitted) this.reset();
    this.move(picture);
  }

  #build() {
    this.#clear();
    const { kinds, rowKinds, size, convention, solid, labels, placed, row } = this.#subject;
    const { frames, mechanism } = this.#picture;
    this.palette = paletteOf(this.stage);
    const [below, above] = (this.shapes = [
      new Shapes(this.palette, this.solids, this.size, this.camera),
      new Shapes(this.palette, this.over, this.size, this.camera),
    ]);
    this.mechanism = mechanism && new MechanismShape(below, kinds, size, mechanism);
    const count = frames?.length ?? 0;
    this.chain = count > 1 ? new ChainShape(solid ? below : above, rowKinds, convention, size, count, solid) : null;
    this.frames = count ? new FramesShape(above, [...Array(count).keys()].map(String), 0.2 * size) : null;
    if (this.mechanism) this.solids.add(this.mechanism.group);
    if (this.chain) (solid ? this.solids : this.over).add(this.chain.group);
    if (this.frames) this.over.add(this.frames.group);
    this.placed = placed.length ? new FramesShape(above, placed, 0.2 * size) : null;
    if (this.placed) this.over.add(this.placed.group);
    // The labels of later parts give way to those of earlier ones.
    this.ghosts = mechanism && new GhostFrames(above, labels, GHOST * size);
    this.gap = mechanism && new GapShape(above, size, this.stage);
    if (this.ghosts && this.gap) this.over.add(this.ghosts.group, this.gap.group);
    this.row = row(above, size, this.stage);
    if (this.row) this.over.add(this.row.group);
    for (const each of this.shapes) each.finish();
  }

  #clear() {
    const parts = [this.mechanism, this.chain, this.frames, this.placed, this.ghosts, this.gap, this.row];
    for (const part of parts) part?.group.removeFromParent();
    this.gap?.dispose();
    this.row?.dispose();
    for (const each of this.shapes ?? []) each.dispose();
  }

  recolour() {
    const palette = paletteOf(this.stage);
    if (!this.#picture || palette === this.palette) return;
    this.#build();
    this.move(this.#picture);
  }

  /**
   * Show another picture of the same subject.
   *
   * @param {Front.Picture} picture
   */
  move(picture) {
    this.#picture = picture;
    const { shown, robot, beside, given, shownPlaced, gap, shownRow } = this.#subject;
    if (this.mechanism && picture.mechanism) this.mechanism.put(picture.mechanism);
    if (this.ghosts && picture.mechanism) this.ghosts.put(picture.mechanism.frames);
    if (this.ghosts) this.ghosts.group.visible = given();
    this.placed?.put(picture.placed ?? [], shownPlaced);
    this.gap?.put(beside() ? null : gap(picture));
    if (this.mechanism) this.mechanism.group.visible = robot();
    if (picture.frames) {
      this.chain?.put(picture.frames);
      this.frames?.put(picture.frames, shown);
    }
    const aside = beside() ? this.aside : new Vector3();
    this.chain?.group.position.copy(aside);
    this.frames?.group.position.copy(aside);
    this.row?.put(shownRow(picture), aside);
    if (this.#wasInside && !this.#isInside()) this.#fit(this.camera.position.clone().sub(this.controls.target));
    this.draw();
  }

  /** Return all points that the view must contain. */
  #points() {
    const { mechanism, frames, placed } = this.#picture;
    const { beside } = this.#subject;
    const robot = mechanism
      ? [mechanism.base, mechanism.tool, ...mechanism.centres, ...mechanism.links.flat()].map(vector)
      : [];
    const chain = (frames ?? []).map((frame) => vector(column(frame, 3)));
    robot.push(...(placed ?? []).map((frame) => vector(column(frame, 3))));
    return [...robot, ...chain.map((point) => (beside() ? point.add(this.aside) : point))];
  }

  /** The robot as it is drawn, and its size. */
  get robot() {
    return { mechanism: this.#picture?.mechanism ?? null, size: this.#subject?.size ?? 1 };
  }

  /**
   * Return the place of a point on the stage, in pixels from its upper left corner.
   *
   * @param {number[]} point
   */
  onStage(point) {
    this.camera.updateMatrixWorld();
    const { x, y } = vector(point).project(this.camera);
    return [((x + 1) / 2) * this.size.x, ((1 - y) / 2) * this.size.y];
  }

  /** Return the two ends of each joint axis on the stage. */
  axesOnStage() {
    const { mechanism, size } = this.robot;
    const { centres, axes } = mechanism ?? { centres: [], axes: [] };
    return centres.map((centre, i) =>
      [-AXIS, AXIS].map((share) => this.onStage(centre.map((value, k) => value + share * size * axes[i][k])))
    );
  }

  /** True if all points are in the picture. */
  #isInside() {
    this.camera.updateMatrixWorld();
    return this.#points().every((point) => {
      const { x, y } = point.project(this.camera);
      return Math.abs(x) < 1 && Math.abs(y) < 1;
    });
  }

  /** Restore the initial view, with everything in it. */
  reset() {
    const { azimuth, elevation } = this.#subject;
    const [turn, height] = [azimuth, elevation].map((angle) => (angle * Math.PI) / 180);
    const towards = new Vector3(Math.cos(height) * Math.cos(turn), Math.cos(height) * Math.sin(turn), Math.sin(height));
    const across = new Vector3(-Math.sin(turn), Math.cos(turn), 0);
    this.aside = new Vector3();
    const widths = this.#points().map((point) => point.dot(across));
    const width = Math.max(...widths, 0) - Math.min(...widths, 0);
    this.aside = across.clone().multiplyScalar(width + 0.45 * this.#subject.size);
    this.#fit(towards);
  }

  /**
   * Move the camera into the direction `offset`, to where everything is in the picture.
   *
   * @param {Vector3} offset
   */
  #fit(offset) {
    const towards = offset.clone().normalize();
    const across = new Vector3(-towards.y, towards.x, 0).normalize();
    const points = this.#points();
    const low = points.reduce((least, point) => least.min(point), points[0]?.clone() ?? new Vector3());
    const high = points.reduce((most, point) => most.max(point), low.clone());
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const up = new Vector3().crossVectors(towards, across);
    // The names of the given frames are farther from their points than all other parts. Their size in pixels is fixed.
    const room = NAMES * GHOST * this.#subject.size;
    const [width, height] = [this.size.x, this.size.y].map((pixels) => Math.max(1 - (2 * LETTERS) / pixels, 0.5));
    const half = Math.tan(((FIELD_OF_VIEW / 2) * Math.PI) / 180);
    const needed = points.map((point) => {
      const from = point.clone().sub(middle);
      const [over, beside] = [up, across].map((direction) => Math.abs(from.dot(direction)) + room);
      const sides = [over / height, beside / (width * this.camera.aspect)];
      return from.dot(towards) + Math.max(...sides) / half;
    });
    this.distance = Math.max(...needed, this.#subject.size);
    this.camera.near = this.distance / 100;
    this.camera.far = this.distance * 10;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.minDistance = this.distance / 10;
    this.controls.maxDistance = this.distance * 4;
    this.camera.position.copy(middle).addScaledVector(towards, this.distance);
    this.controls.update();
    this.#fitted = true;
    this.#wasInside = true;
    this.draw();
  }

  /**
   * Orbit by angles in radians, and zoom by a factor.
   *
   * @param {number} right
   * @param {number} up
   * @param {number} [nearer]
   */
  turn(right, up, nearer = 1) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const size = offset.length();
    const azimuth = Math.atan2(offset.y, offset.x) + right;
    const elevation = Math.max(-STEEPEST, Math.min(STEEPEST, Math.asin(offset.z / size) + up));
    offset.set(Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation));
    const { minDistance, maxDistance } = this.controls;
    offset.multiplyScalar(Math.max(minDistance, Math.min(maxDistance, size / nearer)));
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.#ratio(true));
    this.renderer.setSize(width, height);
    this.size.set(width, height);
    const before = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.#picture && Math.abs(before - this.camera.aspect) > 0.02) this.reset();
    this.#render();
  }

  /** Redraw in the next frame of the screen. */
  draw() {
    if (!this.#asked) this.#asked = requestAnimationFrame(() => this.#render());
  }

  /**
   * Return the number of canvas pixels for each pixel of the page.
   *
   * @param {boolean} fine
   */
  #ratio(fine) {
    if (!this.inSoftware) return Math.min(devicePixelRatio, 2);
    return fine ? FINE : 1;
  }

  #render(fine = !this.inSoftware) {
    cancelAnimationFrame(this.#asked);
    clearTimeout(this.resting);
    this.#asked = 0;
    if (this.inSoftware && !fine) this.resting = setTimeout(() => this.#render(true), AT_REST);
    if (this.renderer.getPixelRatio() !== this.#ratio(fine)) this.renderer.setPixelRatio(this.#ratio(fine));
    const texts = [...(this.gap ? [this.gap.text] : []), ...(this.row?.texts ?? [])];
    const taken = texts.flatMap((text) => text.follow(this.camera, this.size));
    for (const each of this.shapes ?? []) each.put(taken);
    this.renderer.clear();
    this.renderer.render(this.solids, this.camera);
    this.renderer.clearDepth();
    this.renderer.render(this.over, this.camera);
    this.drawn();
  }

  dispose() {
    cancelAnimationFrame(this.#asked);
    clearTimeout(this.resting);
    this.stop.abort();
    this.themes.disconnect();
    this.resizing.disconnect();
    this.controls.dispose();
    this.#clear();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }
}
