// A hand-in that the service has not confirmed yet. It is kept in the browser, so that it is sent again after a reload
// with the same key: the service then records it once.

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
      // Without storage, a reload forgets it.
    }
  }

  /** Forget the hand-in with this key; that of another tab stays. @param {string} key */
  clear(key) {
    const isStored = this.get()?.key === key;
    // Also if another tab has saved its own: what is confirmed must never be sent as pending again.
    if (this.#inMemory?.key === key) this.#inMemory = null;
    if (!isStored) return;
    try {
      localStorage.removeItem(this.name);
    } catch {
      // There is no storage.
    }
  }
}
