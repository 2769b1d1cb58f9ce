// The types of what the 3D view uses of three.js; all else is left out.
export class Vector2 {
  constructor(x?: number, y?: number);
  x: number;
  y: number;
  set(x: number, y: number): this;
}
export class Vector3 {
  constructor(x?: number, y?: number, z?: number);
  x: number;
  y: number;
  z: number;
  set(x: number, y: number, z: number): this;
  setScalar(value: number): this;
  copy(other: Vector3): this;
  clone(): Vector3;
  add(other: Vector3): this;
  sub(other: Vector3): this;
  addScaledVector(other: Vector3, scale: number): this;
  multiplyScalar(scale: number): this;
  divideScalar(scale: number): this;
  crossVectors(a: Vector3, b: Vector3): this;
  min(other: Vector3): this;
  max(other: Vector3): this;
  dot(other: Vector3): number;
  length(): number;
  distanceTo(other: Vector3): number;
  normalize(): this;
  project(camera: PerspectiveCamera): this;
  toArray(): [number, number, number];
}
export class Matrix4 {
  elements: number[];
  // deno-fmt-ignore
  set(
    a: number, b: number, c: number, d: number, e: number, f: number, g: number, h: number,
    i: number, j: number, k: number, l: number, m: number, n: number, o: number, p: number,
  ): this;
}
export class Quaternion {
  setFromUnitVectors(from: Vector3, to: Vector3): this;
}
export class Color {
  constructor(colour: string | number);
  constructor(red: number, green: number, blue: number);
}
export const MOUSE: { ROTATE: number; DOLLY: number; PAN: number };
export const SRGBColorSpace: string;

export class Object3D {
  position: Vector3;
  quaternion: Quaternion;
  scale: Vector3;
  up: Vector3;
  visible: boolean;
  children: Object3D[];
  matrix: Matrix4;
  matrixWorld: Matrix4;
  matrixAutoUpdate: boolean;
  matrixWorldNeedsUpdate: boolean;
  frustumCulled: boolean;
  renderOrder: number;
  // What a part is of: whoever draws it says what that is.
  // deno-lint-ignore no-explicit-any
  userData: any;
  add(...objects: Object3D[]): this;
  removeFromParent(): this;
  updateMatrixWorld(force?: boolean): void;
  traverseVisible(visit: (object: Object3D) => void): void;
}
export class Group extends Object3D {}
export class Scene extends Object3D {}
export class PerspectiveCamera extends Object3D {
  constructor(fieldOfView: number, aspect: number, near: number, far: number);
  aspect: number;
  near: number;
  far: number;
  updateProjectionMatrix(): void;
}
export class DirectionalLight extends Object3D {
  constructor(colour: Color, intensity: number);
}
export class HemisphereLight extends Object3D {
  constructor(sky: number, ground: number, intensity: number);
}

export class BufferAttribute {
  needsUpdate: boolean;
  setXYZ(index: number, x: number, y: number, z: number): this;
  setXYZW(index: number, x: number, y: number, z: number, w: number): this;
}
export class InstancedBufferAttribute extends BufferAttribute {
  constructor(array: Float32Array, itemSize: number);
}
export class BufferGeometry {
  index: BufferAttribute | null;
  attributes: Record<string, BufferAttribute>;
  setIndex(index: BufferAttribute | null): this;
  setAttribute(name: string, attribute: BufferAttribute): this;
  dispose(): void;
}
export class InstancedBufferGeometry extends BufferGeometry {
  instanceCount: number;
}
export class BoxGeometry extends BufferGeometry {
  constructor(width: number, height: number, depth: number);
}
export class ConeGeometry extends BufferGeometry {
  constructor(radius: number, height: number, segments: number);
}
export class CylinderGeometry extends BufferGeometry {
  constructor(top: number, bottom: number, height: number, segments: number);
}
export class PlaneGeometry extends BufferGeometry {
  constructor(width: number, height: number);
}
export class SphereGeometry extends BufferGeometry {
  constructor(radius: number, across: number, along: number);
}

export class Material {
  dispose(): void;
}
export class MeshBasicMaterial extends Material {}
export class MeshLambertMaterial extends Material {}
export class ShaderMaterial<Uniforms extends Record<string, { value: unknown }>> extends Material {
  constructor(options: {
    uniforms: Uniforms;
    vertexShader: string;
    fragmentShader: string;
    depthTest: boolean;
    transparent: boolean;
    premultipliedAlpha: boolean;
  });
  uniforms: Uniforms;
}
export class CanvasTexture {
  constructor(canvas: HTMLCanvasElement);
  premultiplyAlpha: boolean;
  dispose(): void;
}
export class Mesh<Geometry extends BufferGeometry, Kind extends Material> extends Object3D {
  constructor(geometry: Geometry, material: Kind);
  geometry: Geometry;
  material: Kind;
}
export class InstancedMesh extends Mesh<BufferGeometry, Material> {
  constructor(geometry: BufferGeometry, material: Material, count: number);
  count: number;
  instanceMatrix: BufferAttribute;
  instanceColor: BufferAttribute | null;
  setMatrixAt(index: number, matrix: Matrix4): void;
  setColorAt(index: number, colour: Color): void;
  dispose(): void;
}
export class WebGLRenderer {
  constructor(options: { antialias: boolean; alpha: boolean });
  domElement: HTMLCanvasElement;
  outputColorSpace: string;
  autoClear: boolean;
  setPixelRatio(ratio: number): void;
  getPixelRatio(): number;
  setSize(width: number, height: number): void;
  clear(): void;
  clearDepth(): void;
  render(scene: Scene, camera: PerspectiveCamera): void;
  dispose(): void;
  forceContextLoss(): void;
}
