// The colours of the page around the element. Light text means a dark page, whatever colours the system prefers.

import { isDark } from "../../robot/palette.js";

const DARK_SYSTEM = matchMedia("(prefers-color-scheme: dark)");

export class PageColours {
  #follow = () => this.#apply();
  // A page that changes its colours changes an attribute of its root or body.
  #observer = new MutationObserver(this.#follow);
  /** @type {"light" | "dark"} */
  scheme = "light";

  /**
   * Give `inner` the page's colour scheme, or that in the attribute `theme` of `host`. Call `changed` after changes.
   *
   * @param {HTMLElement} host
   * @param {HTMLElement} inner
   * @param {() => void} changed
   */
  constructor(host, inner, changed) {
    this.host = host;
    this.inner = inner;
    this.changed = changed;
  }

  start() {
    for (const each of [document.documentElement, document.body]) this.#observer.observe(each, { attributes: true });
    DARK_SYSTEM.addEventListener("change", this.#follow);
    this.#apply();
  }

  stop() {
    this.#observer.disconnect();
    DARK_SYSTEM.removeEventListener("change", this.#follow);
  }

  #apply() {
    const theme = this.host.getAttribute("theme");
    const dark = theme === "auto" ? DARK_SYSTEM.matches : theme ? theme === "dark" : isDark(this.host);
    const scheme = dark ? "dark" : "light";
    if (this.inner.dataset.scheme === scheme) return;
    this.inner.dataset.scheme = this.scheme = scheme;
    this.changed();
  }

  /**
   * Return the address of a figure in this scheme; it has no query if the browser chooses this scheme anyway.
   *
   * @param {string} address
   */
  figure(address) {
    return (this.scheme === "dark") === DARK_SYSTEM.matches ? address : `${address}?theme=${this.scheme}`;
  }
}
