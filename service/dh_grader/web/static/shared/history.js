// Undo and redo for all cells of an exercise. A step is a list of changes that were made together.

const STEPS = 500;
// Keys typed into one cell are one step if the pauses between them are shorter than these milliseconds.
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
   * Add changes `{target, before, after}` as a step. Typing may extend the last step instead.
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

  /** Undo the last step. Return the target to show, or null if there is no step. */
  undo() {
    return this.#move(this.#past, this.#future, "before");
  }

  /** Redo the step that was undone last. Return the target to show, or null if there is no step. */
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
