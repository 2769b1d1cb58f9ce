// The view of a moving robot: it decides what to request from the service, and when. The service computes
// the pictures, `stage.js` shows them, in 3D if the browser can, and `view_panels.js` has the controls.

import { h } from "../shared/dom.js";
import { ViewWords } from "./frames/view_words.js";
import { pictureOf, sizeOf, Sweep } from "./motion.js";
import { leftOutText } from "./placing/placed_words.js";
import { PlacingLoader } from "./placing/placing_loader.js";
import { RowLoader } from "./rows/row_loader.js";
import { Stage } from "./stage.js";
import { FrameSwitches, JointSliders, PoseNumbers, SymbolFields } from "./view_panels.js";
import { worded } from "../shared/words/words.js";
import { typesetMessage } from "../typeset/names.js";

const STYLE = new URL("./robot_view.css", import.meta.url).href;
const AFTER_A_KEY = 250;
const RETRY = 3000;

export class RobotView {
  /** @type {Api.Frames | null} */
  #answer = null;
  /** @type {Record<string, number>} */
  #values = {};
  /** @type {Record<string, number>} */
  #symbols = {};
  /** @type {Sweep | null} */
  #sweep = null;
  #turn = 0;
  #pending = 0;
  #isWaiting = false;
  #dragging = false;
  #refit = false;
  #timer = 0;
  #closed = false;
  /** @type {Front.Picture | undefined} */
  picture;
  /** @type {string | null | undefined} */
  structure = null;

  /**
   * `host` has: `service`; `body()`, the fields of every request, or null; `descriptions` of symbols by name; the
   * `unit` of lengths; `cells()`, the rows of the table that is drawn;
   * `announce`; `answered`, called with each answer, and with true if the earlier picture stays; `moved`, called with
   * each picture.
   *
   * @param {Front.ViewHost} host
   */
  constructor(host) {
    this.host = host;
    this.words = new ViewWords((text) => this.rows.isOpen || host.announce?.(text), host.unit ?? "m"); // rows have their own words
    this.stage = new Stage((theme) => this.#drawing(theme), this.words.text.id, () => this.#stageChanged());
    this.told = h("p", { class: "told" });
    const [draw, build] = [
      () => this.#draw(),
      () => this.#answer && this.picture && this.#showScene(this.#answer, this.picture),
    ];
    this.rows = new RowLoader({ host, isFlat: () => this.stage.isFlat, draw, build });
    this.placing = new PlacingLoader(host, this.stage, () => ({ symbols: this.#symbols, joints: this.#current }));
    this.numbers = new PoseNumbers();
    this.sliders = new JointSliders(this);
    this.symbols = new SymbolFields((name, value) => this.#chosen(name, value), host.descriptions);
    this.frames = new FrameSwitches(() => this.#draw());
    this.robot = this.#switch(worded("Robot"), true);
    this.beside = this.#switch(worded("Side by side"), false, () => this.stage.reset());
    this.home = h(
      "button",
      { type: "button", class: "quiet-button", onclick: () => this.goHome() },
      worded("Home configuration"),
    );
    this.given = this.#switch(worded("Given frames"), true);
    this.placed = this.#switch(worded("Your frames"), true);
    this.over = h("div", { class: "switches" }, this.robot.label, this.beside.label);
    this.element = h(
      "section",
      { class: "robot-view", "aria-label": worded("3D view") },
      h("link", { rel: "stylesheet", href: STYLE }),
      this.stage.element,
      this.words.text,
      this.words.legend,
      this.told,
      this.rows.element,
      this.sliders.element,
      h("div", { class: "switches" }, this.home, this.given.label, this.placed.label, this.over),
      this.frames.element,
      this.numbers.element,
      this.symbols.element,
    );
  }

  /** Load the stage, and draw. */
  async open() {
    await this.stage.open();
    this.rows.open();
    this.placing.open();
    await this.#refresh();
  }

  /** Show the picture in the 3D scene, which has replaced a drawing. */
  #stageChanged() {
    this.placing.open();
    this.#show(this.#answer);
  }

  close() {
    this.#closed = true;
    clearTimeout(this.#timer);
    this.words.close();
    this.rows.close();
    this.placing.close();
    this.stage.close();
    this.element.remove();
  }

  /** @param {string} text @param {boolean} on @param {() => void} [changed] */
  #switch(text, on, changed) {
    const box = h("input", { type: "checkbox", checked: on, onchange: () => (this.#draw(), changed?.()) });
    return { box, label: h("label", {}, box, " ", text) };
  }

  // Requests to the service.

  /** Request a new picture after a pause, because the table has changed. */
  changed() {
    this.#sweep = null;
    // Ignore the answers of running requests: they are about the earlier table.
    this.#turn += 1;
    clearTimeout(this.#timer);
    this.#isWaiting = true;
    this.#busy(0);
    this.#timer = setTimeout(() => this.#refresh(), AFTER_A_KEY);
  }

  /** Reset the view with the next picture. */
  refit() {
    this.#refit = true;
  }

  /** Forget the values of joints and symbols, because another robot follows. */
  forget() {
    this.#values = {};
    this.#symbols = {};
    // Another robot may have the same structure; its joint values are unknown, too.
    this.structure = null;
    this.frames.showAll();
  }

  /** @param {number[][] | null} sets @param {Api.FramesRequest | null} [body] */
  async #request(sets, body = this.host.body()) {
    this.#busy(1);
    try {
      return await this.host.service.frames({ ...body, symbols: this.#symbols, ...(sets ? { joints: sets } : {}) });
    } finally {
      this.#busy(-1);
    }
  }

  /**
   * Tell screen readers whether the picture is about to change.
   *
   * @param {number} step
   */
  #busy(step) {
    this.#pending += step;
    this.element.setAttribute("aria-busy", String(this.#isWaiting || this.#pending > 0));
  }

  /**
   * Request the picture at the current joint values.
   *
   * @returns {Promise<void>}
   */
  async #refresh() {
    const turn = ++this.#turn;
    const body = this.host.body();
    this.#dragging = false;
    this.#isWaiting = false;
    this.#busy(0);
    if (!body) return this.#show(null);
    try {
      const values = this.#answer && this.#current;
      const answer = await this.#request(values && this.#isSame(body) ? [values] : null);
      if (turn !== this.#turn || this.#closed) return undefined;
      // While the student types, the table may be unreadable. The earlier picture is better than none.
      if (!answer.mechanism && isUnread(answer) && this.picture && this.#isSame(body)) return this.#keep(answer);
      const missing = answer.joints.some(({ variable }) => !(variable in this.#values));
      this.#remember(answer, body);
      // If the joints had changed, the response is for home values. Repeat the request with the user's values.
      if (!missing && !(values && this.#isSame(body)) && this.#moved(answer)) return this.#refresh();
      this.#show(answer);
    } catch (error) {
      if (turn !== this.#turn || this.#closed) return undefined;
      this.told.replaceChildren(...typesetMessage(error.message));
      if (error.kind !== "refused") this.#timer = setTimeout(() => this.#refresh(), RETRY);
    }
    return undefined;
  }

  /**
   * Show what cannot be read, and keep the earlier picture.
   *
   * @param {Api.Frames} answer
   */
  #keep(answer) {
    this.#stale(true);
    this.#showTold(answer);
    this.host.answered?.(answer, true);
  }

  /** @param {boolean} isStale */
  #stale(isStale) {
    for (const each of [this.stage, this.numbers, this.sliders]) each.element.classList.toggle("stale", isStale);
    this.sliders.element.inert = this.home.disabled = isStale;
  }

  /** @param {Api.FramesRequest} body */
  #isSame(body) {
    return this.structure === (body.table?.structure ?? body.exercise);
  }

  /** @param {Api.Frames} answer @param {Api.FramesRequest} body */
  #remember(answer, body) {
    this.structure = body.table?.structure ?? body.exercise;
    this.#answer = answer;
    for (const { variable, home } of answer.joints) this.#values[variable] ??= home;
    this.host.answered?.(answer, false);
  }

  /** @param {Api.Frames} answer */
  #moved(answer) {
    return answer.joints.some(({ variable, home }) => this.#values[variable] !== home);
  }

  get #current() {
    return this.#answer?.joints.map(({ variable }) => this.#values[variable]) ?? [];
  }

  /**
   * Request the current picture as SVG, for a browser without WebGL.
   *
   * @param {Api.Theme} figure
   */
  async #drawing(figure) {
    const body = this.host.body();
    if (!body || !this.#answer) return null;
    return (await this.#request([this.#current], { ...withoutFormulas(body), figure })).figure;
  }

  /** @param {Api.Frames | null} answer */
  #show(answer) {
    this.#answer = answer;
    this.element.classList.toggle("empty", !answer);
    this.#stale(false);
    if (!answer) return;
    this.picture = pictureOf(answer);
    this.words.show(answer);
    this.given.label.hidden = this.stage.isFlat || !answer.mechanism?.frames.length;
    this.placed.label.hidden = this.stage.isFlat || !answer.placed?.labels.length;
    this.sliders.show(answer.joints, this.#values);
    this.symbols.show(answer.symbols);
    this.#showTold(answer);
    // A drawing has no switches: it shows everything.
    this.over.hidden = this.stage.isFlat || !(answer.mechanism && answer.table);
    if (!this.stage.isFlat) this.frames.show(this.picture.frames?.length ?? 0);
    this.#showScene(answer, this.picture);
    this.#showNumbers();
  }

  /** @param {Api.Frames} answer @param {Front.Picture} picture */
  #showScene({ joints, mechanism, table, placed }, picture) {
    const { frames } = picture;
    const kinds = new Map(joints.map(({ joint, kind }) => [joint, kind]));
    // The sizes of parts do not change while joints move.
    /** @type {Front.Subject} */
    const subject = {
      kinds: joints.map(({ kind }) => kind),
      rowKinds: table?.row_joints.map((joint) => kinds.get(joint) ?? null) ?? [],
      convention: this.#convention,
      size: mechanism?.size ?? sizeOf(frames ?? []),
      azimuth: mechanism?.azimuth ?? -60,
      elevation: mechanism?.elevation ?? 25,
      solid: !mechanism,
      beside: () => this.beside.box.checked,
      robot: () => this.robot.box.checked || !frames,
      shown: (i) => this.frames.isShown(i),
      labels: mechanism?.frames ?? [],
      given: () => this.given.box.checked,
      placed: placed?.labels ?? [],
      shownPlaced: () => this.placed.box.checked,
      gap: (shown) => this.words.gap(shown),
      row: this.rows.shape,
      shownRow: (shown) => this.rows.shown(shown),
    };
    this.stage.show(subject, picture);
    if (this.#refit) this.stage.reset();
    this.#refit = false;
  }

  // Joints and symbols.

  /**
   * Fetch the sweep of a joint, unless it is already there.
   *
   * @param {number} i
   */
  prepare(i) {
    const body = this.host.body();
    // If the joints have changed since the last response, the new joint values are not known yet.
    if (!this.#answer || !body || !this.#isSame(body)) return;
    const values = this.#current;
    const others = JSON.stringify([body, this.#symbols, values.with(i, 0)]);
    if (this.#sweep?.index === i && this.#sweep.others === others) return;
    // All requests of the sweep are about the current table, even if its joints change meanwhile.
    const asked = withoutFormulas(body);
    const sweep = new Sweep((sets) => this.#request(sets, asked), values, i, this.#answer.joints[i], others);
    this.#sweep = sweep;
    // When the user releases the slider, an exact picture follows. The sweep must not replace this picture.
    sweep.load(() => sweep === this.#sweep && this.#dragging && this.#follow()).catch(() =>
      sweep === this.#sweep && (this.#sweep = null)
    );
  }

  /** @param {number} i @param {number} value */
  dragged(i, value) {
    if (!this.#answer) return;
    this.#values[this.#answer.joints[i].variable] = value;
    this.#turn += 1;
    this.#dragging = true;
    this.sliders.put(i, value);
    this.prepare(i);
    this.#follow();
  }

  released() {
    this.#refresh();
  }

  /** Draw the moving joint at the value of its slider. */
  #follow() {
    const sweep = this.#sweep;
    if (!sweep?.isReady || this.#closed) return;
    this.picture = sweep.at(this.#current[sweep.index]);
    this.#draw();
    this.#showNumbers();
  }

  goHome() {
    if (!this.#answer) return;
    for (const { variable, home } of this.#answer.joints) this.#values[variable] = home;
    this.#sweep = null;
    this.#refresh();
    this.host.announce?.(worded("Home configuration"));
  }

  #draw() {
    if (this.picture) this.stage.move(this.picture);
  }

  /** @param {string} name @param {number} value */
  #chosen(name, value) {
    this.#symbols = { ...this.#symbols, [name]: value };
    this.changed();
  }

  /** @param {Api.Frames} answer */
  #showTold({ table, placed }) {
    const [cell] = table?.unread ?? [];
    const unread = cell &&
      worded("Row {row}, {column}: {reason}", { row: cell.row, column: cell.column, reason: cell.error.message });
    const reason = table?.error?.message ?? unread;
    const lost = table?.lost_freedoms.map((each) => each.message) ?? [];
    const isKept = this.stage.element.classList.contains("stale");
    const ends = reason && isKept
      ? worded("The view shows your last valid table.")
      : reason && table?.frames[0]?.length
      ? worded("The view shows the frames before it.")
      : "";
    this.told.replaceChildren(
      ...typesetMessage([reason, ends, leftOutText(placed), ...lost].filter(Boolean).join(" ")),
    );
    this.told.hidden = !this.told.textContent;
  }

  get #convention() {
    return this.host.body()?.table?.convention ?? "standard";
  }

  #showNumbers() {
    if (!this.picture || !this.#answer) return;
    this.rows.show(this.#answer, this.picture, this.#convention);
    this.numbers.show(this.picture, this.words.gap(this.picture));
    this.words.describe(this.picture);
    this.host.moved?.(this.picture);
  }
}

/** @param {Api.Frames} answer */
const isUnread = ({ table }) => Boolean(table?.error || table?.unread.length);

/**
 * Return a request without formulas, which sweeps and drawings do not need.
 *
 * @param {Api.FramesRequest} body
 */
function withoutFormulas({ table, ...body }) {
  return table ? { ...body, table: { ...table, formulas: false } } : body;
}
