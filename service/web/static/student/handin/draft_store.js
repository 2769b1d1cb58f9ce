// The saved answers to an exercise of an assignment. Answers that another tab has changed are not overwritten.

import { Store } from "../../shared/storage.js";
import { worded } from "../../shared/words/words.js";

export class DraftStore extends Store {
  /** @type {string | null} */
  #seen = null;
  /** @type {(event: StorageEvent) => void} */
  #listener = ({ key }) => {
    if (key === this.name && this.isChanged) this.changed();
  };

  /**
   * `changed` is called if another tab has changed the answers.
   *
   * @param {string} base
   * @param {string} name
   * @param {() => void} changed
   */
  constructor(base, name, changed) {
    super(base, name);
    this.changed = changed;
    addEventListener("storage", this.#listener);
  }

  close() {
    removeEventListener("storage", this.#listener);
  }

  /** True if another tab has changed the answers since this one loaded or saved them. */
  get isChanged() {
    return this.#saved !== this.#seen;
  }

  get #saved() {
    try {
      return localStorage.getItem(this.name);
    } catch {
      return this.#seen;
    }
  }

  /** @override */
  load() {
    this.#seen = this.#saved;
    return super.load();
  }

  /** Let the next `save` replace what the other tab has saved. */
  keepMine() {
    this.#seen = this.#saved;
  }

  /** @override @param {Front.Answers | null} answers */
  save(answers) {
    if (this.isChanged) {
      this.changed();
      this.unsaved = worded("Not saved yet: choose above which answers to keep");
      return false;
    }
    const isSaved = super.save(answers);
    this.#seen = this.#saved;
    return isSaved;
  }
}
