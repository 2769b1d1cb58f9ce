// The clock that plays a row: it goes through the row's moves, one after another.

// Milliseconds for a move, for a move that moves nothing, and after each jump if people want no motion.
const MOVE = 1300;
const STILL = 350;
const JUMP = 1600;
// The longest time between two pictures that counts, in milliseconds: a page in the background does not jump ahead.
const LONGEST = 100;
const SMALL = 1e-9;

export class Playback {
  #frame = 0;
  #timer = 0;
  #before = 0;
  #end = 0;

  /**
   * `moved(at)` is called for each picture, `stopped()` at the end.
   *
   * @param {(at: number) => void} moved
   * @param {(isEnd: boolean) => void} stopped
   */
  constructor(moved, stopped) {
    this.moved = moved;
    this.stopped = stopped;
    this.at = 0;
  }

  get isRunning() {
    return this.#frame !== 0 || this.#timer !== 0;
  }

  /**
   * Play from the current place to `end`. `isStill(i)` says whether move `i` moves nothing.
   *
   * @param {number} end
   * @param {(i: number) => boolean} isStill
   */
  play(end, isStill) {
    this.stop();
    this.#end = end;
    this.isStill = isStill;
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return this.#jump();
    this.#before = performance.now();
    this.#frame = requestAnimationFrame((now) => this.#step(now));
  }

  /** Show the end of the current move, then the ends of the next moves. */
  #jump() {
    this.at = Math.min(this.#end, Math.floor(this.at + SMALL) + 1);
    this.#timer = 0;
    if (this.at < this.#end) this.#timer = setTimeout(() => this.#jump(), JUMP);
    this.moved(this.at);
    if (!this.#timer) this.stopped(true);
  }

  /** @param {number} now */
  #step(now) {
    const elapsed = Math.max(0, Math.min(LONGEST, now - this.#before));
    this.#before = now;
    const i = Math.floor(this.at + SMALL);
    const at = this.at + elapsed / (this.isStill?.(i) ? STILL : MOVE);
    // Each end of a move gets a picture.
    this.at = Math.min(at, i + 1, this.#end);
    this.#frame = 0;
    if (this.at < this.#end) this.#frame = requestAnimationFrame((next) => this.#step(next));
    this.moved(this.at);
    if (!this.#frame) this.stopped(true);
  }

  stop() {
    const wasRunning = this.isRunning;
    cancelAnimationFrame(this.#frame);
    clearTimeout(this.#timer);
    this.#frame = this.#timer = 0;
    if (wasRunning) this.stopped(false);
  }
}
