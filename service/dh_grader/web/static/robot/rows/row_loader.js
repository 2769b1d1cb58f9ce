// The button worded("Play a row"). It loads the other scripts of this folder at first use, and so does a focused cell.

import { h } from "../../shared/dom.js";
import { later } from "../../shared/later.js";
import { worded } from "../../shared/words/words.js";

export class RowLoader {
  /** @type {Front.RowPlayer | null} */
  #player = null;
  /** @type {Promise<Front.RowPlayer> | null} */
  #loading = null;
  /** @type {[Api.Frames, Front.Picture, Api.Convention] | null} */
  #shown = null;
  #stop = new AbortController();

  /**
   * `view` has: `host`; `isFlat()`; `draw()`, which draws the picture again; `build()`, which also makes the parts of the
   * scene again.
   *
   * @param {Front.RowHost} view
   */
  constructor(view) {
    this.view = view;
    this.button = h(
      "button",
      { type: "button", class: "quiet-button", "aria-expanded": "false", hidden: true, onclick: () => this.#toggle() },
      worded("Play a row"),
    );
    this.panel = h("div", { class: "row-player", hidden: true });
    this.told = h("p", { class: "no-webgl", role: "status" });
    this.element = h("div", {}, this.button, this.told, this.panel);
  }

  /** True if the player is open. */
  get isOpen() {
    return !this.panel.hidden;
  }

  /** Show the length or angle of each cell of the table that gets the focus. */
  open() {
    const root = this.element.getRootNode();
    const { signal } = this.#stop;
    root.addEventListener("focusin", ({ target }) => this.#entered(target), { signal });
    root.addEventListener("focusout", () => this.#player?.light(null), { signal });
  }

  /** @param {EventTarget | null} target */
  async #entered(target) {
    const cells = this.view.host.cells?.() ?? [];
    const row = cells.findIndex((each) => each.some(({ input }) => input === target));
    const cell = cells[row]?.find(({ input }) => input === target);
    if (!cell || !this.#shown?.[1].values?.[row]) return;
    const player = await this.#load().catch(() => null);
    if (cell.input.matches(":focus")) player?.light({ row: row + 1, parameter: cell.place.label });
  }

  #load() {
    this.#loading ??= this.#made();
    this.#loading.catch(() => (this.#loading = null));
    return this.#loading;
  }

  async #made() {
    const { RowPlayer } = await later(import.meta.resolve("./row_player.js"), () => import("./row_player.js"));
    const player = new RowPlayer(this.view, this.panel);
    await player.open();
    if (this.#stop.signal.aborted) throw new Error(worded("The view is closed."));
    this.#player = player;
    if (this.#shown) player.show(...this.#shown);
    if (!this.view.isFlat()) this.view.build();
    return player;
  }

  async #toggle() {
    this.button.setAttribute("aria-busy", "true");
    try {
      const isOpen = (await this.#load()).toggle();
      this.told.textContent = "";
      this.button.setAttribute("aria-expanded", String(isOpen));
    } catch {
      this.told.textContent = worded(
        "The player of rows could not be loaded. Check your connection, then try again.",
      );
    }
    this.button.removeAttribute("aria-busy");
  }

  /** @param {Api.Frames} answer @param {Front.Picture} picture @param {Api.Convention} convention */
  show(answer, picture, convention) {
    this.#shown = [answer, picture, convention];
    this.button.hidden = !picture.values?.length;
    if (this.button.hidden && !this.panel.hidden) this.#toggle();
    this.#player?.show(answer, picture, convention);
  }

  /** Return the 3D shape of the row for the scene, or null. @type {Front.Subject["row"]} */
  shape = (shapes, size, stage) => this.#player?.shape(shapes, size, stage) ?? null;

  /** Return the row that is shown in a picture. @param {Front.Picture} picture */
  shown(picture) {
    return this.#player?.shown(picture) ?? null;
  }

  close() {
    this.#stop.abort();
    this.#player?.close();
  }
}
