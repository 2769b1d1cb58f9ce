// A hand-in that the service has not confirmed yet. The browser keeps it, to send it again after a reload. It then has
// the same key, so that the service records it only once.

const LONGEST_PAUSE = 30;

/** Return a new random key for a hand-in. */
export function newKey() {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/**
 * Return the seconds until the next try, after this number of failed tries.
 *
 * @param {number} tries
 */
export function pauseAfter(tries) {
  return Math.min(2 ** tries, LONGEST_PAUSE);
}

/** The unconfirmed hand-in of one learner at one exercise. */
export class PendingHandIn {
  /** @type {Front.Pending | null} */
  #inMemory = null;

  /** @param {string} name of the saved answers */
  constructor(name) {
    this.name = `${name}:hand-in`;
  }

  /** @returns {Front.Pending | null} */
  get() {
    try {
      const found = JSON.parse(localStorage.getItem(this.name) ?? "null");
      const isPending = typeof found?.key === "string" && typeof found.body?.answers === "object";
      return isPending ? found : this.#inMemory;
    } catch {
      return this.#inMemory;
    }
  }

  /** @param {Front.Pending} pending */
  set(pending) {
    this.#inMemory = pending;
    try {
      localStorage.setItem(this.name, JSON.stringify(pending));
    } catch {
      // Without storage, a reload forgets the hand-in.
    }
  }

  /** Forget the hand-in with this key, but no hand-in of another tab. @param {string} key */
  clear(key) {
    const isStored = this.get()?.key === key;
    // A confirmed hand-in must never be sent again, even if another tab has stored its own hand-in.
    if (this.#inMemory?.key === key) this.#inMemory = null;
    if (!isStored) return;
    try {
      localStorage.removeItem(this.name);
    } catch {
      // There is no storage.
    }
  }
}
