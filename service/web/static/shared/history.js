// Undo and redo over all cells of an exercise. A step is a list of changes that were made together.

const STEPS = 500;
// Keys that follow each other so fast in one cell are one step.
const ONE_STEP = 800;

/** @template {{ put(value: any): void }} Target @template Value */
export class History {
  /** @type {Front.Change<Target, Value>[][]} */
  #past = [];
  /** @type {Front.Change<Target, Value>[][]} */
  #future = [];
  /** @type {Target | null} */
  #last = null;
  #at = 0;

  /**
   * Note changes `{target, before, after}`; those by typing are joined with the last ones.
   *
   * @param {Front.Change<Target, Value>[]} changes
   * @param {boolean} [typed]
   */
  note(changes, typed = false) {
    const real = changes.filter(({ before, after }) => before !== after);
    if (!real.length) return;
    const now = performance.now();
    const last = this.#past.at(-1);
    const joined = typed && this.#last === real[0].target && now - this.#at < ONE_STEP;
    if (joined && last) last[0].after = real[0].after;
    else this.#past.push(real.map((change) => ({ ...change })));
    if (this.#past.length > STEPS) this.#past.shift();
    this.#last = typed ? real[0].target : null;
    this.#at = now;
    this.#future = [];
  }

  /** Take the last step back; the target that is to be shown, or null where there is none. */
  undo() {
    return this.#move(this.#past, this.#future, "before");
  }

  /** Make the step again that was taken back last. */
  redo() {
    return this.#move(this.#future, this.#past, "after");
  }

  /**
   * @param {Front.Change<Target, Value>[][]} from
   * @param {Front.Change<Target, Value>[][]} to
   * @param {"before" | "after"} side
   */
  #move(from, to, side) {
    const step = from.pop();
    if (!step) return null;
    to.push(step);
    this.#last = null;
    for (const change of step) change.target.put(change[side]);
    return step[0].target;
  }
}
