// The types of what the 3D view uses of OrbitControls.
import { PerspectiveCamera, Vector3 } from "./three-0.185.1.module.min.js";

export class OrbitControls {
  constructor(camera: PerspectiveCamera, element: HTMLElement);
  mouseButtons: { LEFT: number; MIDDLE: number; RIGHT: number };
  enableZoom: boolean;
  target: Vector3;
  minDistance: number;
  maxDistance: number;
  addEventListener(name: string, listener: () => void): void;
  update(): boolean;
  dispose(): void;
}
