// Pictures: the positions of all parts at given joint values, from POST /v1/frames. A sweep has pictures of one moving
// joint, and interpolates between them. This module computes no kinematics.

// The pictures in a request, and the requests in a sweep: the first is coarse, the others refine it.
const PICTURES = 30;
const REQUESTS = 3;

/**
 * Return a picture of an answer: `{frames, values, mechanism, placed}`; each may be null.
 *
 * @param {Api.Frames} answer
 * @param {number} [i]
 * @returns {Front.Picture}
 */
export function pictureOf(answer, i = 0) {
  const { table, mechanism, placed } = answer;
  return {
    frames: table?.frames[i] ?? null,
    values: table?.values[i] ?? null,
    mechanism: mechanism?.configurations[i] ?? null,
    placed: placed?.frames[i] ?? null,
  };
}

/** Pictures of the robot while one joint moves from one end of its range to the other. */
export class Sweep {
  /** @type {{ amount: number, picture: Front.Picture }[]} */
  #shots = [];

  /**
   * `request` posts sets of joint values, `values` are the values of all joints, `index` is the joint to sweep.
   *
   * @param {(sets: number[][]) => Promise<Api.Frames>} request
   * @param {number[]} values
   * @param {number} index
   * @param {{ low: number, high: number }} range
   * @param {string} [others] says what else the pictures depend on
   */
  constructor(request, values, index, { low, high }, others = "") {
    this.request = request;
    this.values = values;
    this.index = index;
    this.low = low;
    this.high = high;
    this.others = others;
  }

  get isReady() {
    return this.#shots.length > 0;
  }

  /**
   * Fetch all pictures; `arrived` is called after each request.
   *
   * @param {() => void} arrived
   */
  async load(arrived) {
    const step = (this.high - this.low) / (PICTURES - 1);
    for (let turn = 0; turn < REQUESTS; turn++) {
      const amounts = Array.from(
        { length: PICTURES - (turn ? 1 : 0) },
        (_, i) => this.low + (i + turn / REQUESTS) * step,
      );
      const answer = await this.request(amounts.map((amount) => this.values.with(this.index, amount)));
      const shots = amounts.map((amount, i) => ({ amount, picture: pictureOf(answer, i) }));
      this.#shots = [...this.#shots, ...shots].sort((one, other) => one.amount - other.amount);
      arrived();
    }
  }

  /**
   * Return the picture at a value of the joint variable.
   *
   * @param {number} amount
   */
  at(amount) {
    const after = this.#shots.findIndex((shot) => shot.amount >= amount);
    if (after < 0) return this.#shots[this.#shots.length - 1].picture;
    if (after === 0) return this.#shots[0].picture;
    const [from, to] = [this.#shots[after - 1], this.#shots[after]];
    return between(from.picture, to.picture, (amount - from.amount) / (to.amount - from.amount));
  }
}

/**
 * Return the interpolation of two pictures that lie close together.
 *
 * @param {Front.Picture} from
 * @param {Front.Picture} to
 * @param {number} share
 * @returns {Front.Picture}
 */
export function between(from, to, share) {
  /** @type {(a: number[], b: number[]) => number[]} */
  const point = (a, b) => a.map((value, i) => value + share * (b[i] - value));
  /** @type {(a: number[], b: number[]) => number[]} */
  const direction = (a, b) => unit(point(a, b));
  /** @type {(a: number[][], b: number[][]) => number[][]} */
  const points = (a, b) => a.map((each, i) => point(each, b[i]));
  const after = to.frames;
  const placed = to.placed ?? null;
  const one = from.mechanism;
  const other = to.mechanism;
  return {
    frames: after &&
      (from.frames?.slice(0, after.length).map((frame, i) => frameBetween(frame, after[i], point)) ?? null),
    values: from.values && to.values && points(from.values, to.values),
    mechanism: one && other && {
      centres: points(one.centres, other.centres),
      axes: one.axes.map((axis, i) => direction(axis, other.axes[i])),
      links: one.links.map((link, i) => points(link, other.links[i])),
      base: one.base,
      base_normal: one.base_normal,
      tool: point(one.tool, other.tool),
      tool_direction: direction(one.tool_direction, other.tool_direction),
      frames: one.frames.map((frame, i) => frameBetween(frame, other.frames[i], point)),
    },
    placed: placed && (from.placed?.map((frame, i) => frameBetween(frame, placed[i], point)) ?? null),
  };
}

/**
 * Return column `j` of a frame: 0 to 2 are its axes, 3 is its origin.
 *
 * @param {Front.Frame} frame
 * @param {number} j
 * @returns {number[]}
 */
export const column = (frame, j) => [frame[0][j], frame[1][j], frame[2][j]];

/**
 * Return the interpolation of two frames: z and x are interpolated by `point`, then made orthonormal.
 *
 * @param {Front.Frame} from
 * @param {Front.Frame} to
 * @param {(a: number[], b: number[]) => number[]} point
 */
function frameBetween(from, to, point) {
  const [origin, mixedX, mixedZ] = [3, 0, 2].map((j) => point(column(from, j), column(to, j)));
  const z = unit(mixedZ);
  const along = dot(mixedX, z);
  const x = unit(mixedX.map((value, i) => value - along * z[i]));
  const y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]];
  return [0, 1, 2].map((i) => [x[i], y[i], z[i], origin[i]]);
}

/**
 * Return a size for the parts of a chain without a mechanism.
 *
 * @param {Front.Frame[]} frames
 */
export function sizeOf(frames) {
  const origins = frames.map((frame) => column(frame, 3));
  const spans = [0, 1, 2].map((i) =>
    Math.max(0, ...origins.map((each) => each[i])) - Math.min(0, ...origins.map((each) => each[i]))
  );
  return 0.9 * Math.hypot(...spans) || 1;
}

/** @param {number[]} a @param {number[]} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** @param {number[]} vector */
function unit(vector) {
  const size = Math.hypot(...vector) || 1;
  return vector.map((value) => value / size);
}
