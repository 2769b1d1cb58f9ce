// Requests how the service reads the cells: in batches, one request at a time.

const BATCH = 100;
const REMEMBERED = 1000;
// Milliseconds until the next try if the service cannot be reached.
const RETRY = 3000;

export class Previewer {
  /** @type {Map<Front.PartCell, string>} */
  #waiting = new Map();
  /** @type {Map<string, Api.Preview>} */
  #known = new Map();
  #busy = false;
  #timer = 0;

  /**
   * `context` returns exercise and angle unit. `failed` gets each error, and null after the next success.
   *
   * @param {Pick<Front.PreviewService, "previews">} service
   * @param {() => Front.Context} context
   * @param {(error: Error | null) => void} failed
   */
  constructor(service, context, failed) {
    this.service = service;
    this.context = context;
    this.failed = failed;
  }

  /**
   * Request how a cell's text is read. The cell's `understood` gets the reading, unless the text has changed since.
   *
   * @param {Front.PartCell} cell
   */
  ask(cell) {
    const text = cell.text;
    const known = this.#known.get(this.#key(cell, text));
    this.#waiting.delete(cell);
    // Names of joints and directions are not formulas.
    if (text.trim() === "" || cell.place.offers) return cell.understood(null);
    if (known) return cell.understood(known);
    this.#waiting.set(cell, text);
    clearTimeout(this.#timer);
    // Cells that change together, as in a pasted table, are sent together. A timer would wait until the
    // browser has drawn the typed text. Other cells wait while a request is running.
    queueMicrotask(() => this.#send());
  }

  /** True if a response is still to come. */
  get busy() {
    return this.#busy || this.#waiting.size > 0;
  }

  /** @param {Front.PartCell} cell @param {string} text */
  #key(cell, text) {
    return `${cell.place.part}\n${cell.place.quantity}\n${this.context().angle_unit}\n${text}`;
  }

  async #send() {
    if (this.#busy || this.#waiting.size === 0) return;
    const [{ place: { part } }] = this.#waiting.keys();
    const batch = [...this.#waiting].filter(([cell]) => cell.place.part === part).slice(0, BATCH);
    for (const [cell] of batch) this.#waiting.delete(cell);
    const context = this.context();
    const entries = batch.map(([cell, text]) => ({ text, quantity: cell.place.quantity }));
    this.#busy = true;
    let pause = 0;
    try {
      const { results } = await this.service.previews({ ...context, part, entries });
      this.failed(null);
      batch.forEach(([cell, text], i) => this.#show(cell, text, results[i], context));
    } catch (error) {
      this.failed(error);
      if (error.kind !== "refused") {
        for (const [cell, text] of batch) {
          if (cell.text === text && !this.#waiting.has(cell)) this.#waiting.set(cell, text);
        }
        pause = RETRY;
      }
    }
    this.#busy = false;
    if (this.#waiting.size) this.#timer = setTimeout(() => this.#send(), pause);
  }

  /** @param {Front.PartCell} cell @param {string} text @param {Api.Preview} result @param {Front.Context} context */
  #show(cell, text, result, context) {
    if (context.angle_unit !== this.context().angle_unit) return;
    const [oldest] = this.#known.keys();
    if (this.#known.size >= REMEMBERED) this.#known.delete(oldest);
    this.#known.set(this.#key(cell, text), result);
    if (cell.text === text) cell.understood(result);
  }
}
