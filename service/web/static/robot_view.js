// The 3D view with all that moves it: a slider for each joint, numbers for the other symbols, which
// frames are shown, and buttons for whoever has no mouse. It draws what the service computes.

import { h, message, visible } from "./dom.js";
import { column, pictureOf, Sweep } from "./motion.js";
import { symbolName } from "./names.js";

const STYLE = new URL("./robot_view.css", import.meta.url).href;
const AFTER_A_KEY = 250;
const RETRY = 3000;
const STEPS = 400;
const TURN = Math.PI / 12;
const NEARER = 1.25;
const DEGREES = 180 / Math.PI;

/** Whether the browser draws in 3D at all. */
function hasWebGl() {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}

export class RobotView {
  #answer = null;
  #values = {};
  #symbols = {};
  #sweep = null;
  #turn = 0;
  #pending = 0;
  #dragging = false;
  #refit = false;
  #timer = 0;
  #scene = null;
  #hidden = new Set();
  #closed = false;

  /**
   * `host`: `service`; `body()`, what every request says, or null; `descriptions`, of symbols by name; `instead`, an
   * element for a browser without WebGL; `announce`; `answered`, which hears of each answer; `moved`, of each picture.
   */
  constructor(host) {
    this.host = host;
    this.stage = h("div", { class: "stage" });
    this.told = h("p", { class: "told" });
    this.numbers = h("div", { class: "pose-numbers" });
    this.sliders = h("div", { class: "sliders", role: "group", "aria-label": "Joint variables" });
    this.lengths = h("div", { class: "lengths" });
    this.more = h("details", { class: "symbols-more", hidden: true }, h("summary", {}, "Lengths and other symbols"), this.lengths);
    this.frames = h("div", { class: "frames", role: "group", "aria-label": "Frames shown" });
    this.robot = this.#switch("Robot", true);
    this.beside = this.#switch("Side by side", false, () => this.#scene?.reset());
    this.home = h("button", { type: "button", class: "quiet-button", onclick: () => this.goHome() }, "Home configuration");
    this.over = h("div", { class: "switches" }, this.robot.label, this.beside.label);
    this.element = h(
      "section",
      { class: "robot-view", "aria-label": "3D view" },
      h("link", { rel: "stylesheet", href: STYLE }),
      this.stage,
      this.told,
      this.sliders,
      h("div", { class: "switches" }, this.home, this.over),
      this.frames,
      this.numbers,
      this.more,
    );
  }

  /** Load what draws, and draw. */
  async open() {
    if (hasWebGl()) {
      try {
        const { RobotScene } = await import("./scene.js");
        if (this.#closed) return;
        this.#scene = new RobotScene(this.stage);
      } catch {
        this.#withoutPicture("The 3D view could not be loaded.");
      }
    } else {
      this.#withoutPicture("This browser has no WebGL, which the 3D view needs.");
    }
    if (this.#scene) this.#stageControls();
    await this.#refresh();
  }

  close() {
    this.#closed = true;
    clearTimeout(this.#timer);
    this.#scene?.dispose();
    this.element.remove();
  }

  #withoutPicture(reason) {
    const { instead } = this.host;
    const rest = instead ? " Here is the drawing instead; the numbers below follow the joints." : " The numbers below follow the joints.";
    this.stage.replaceChildren(h("p", { class: "no-webgl" }, reason, rest), instead ?? "");
    this.stage.classList.add("flat");
  }

  #stageControls() {
    const { canvas } = this.#scene;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "The robot in 3D. Arrow keys go around it, plus and minus zoom, 0 shows all of it.");
    canvas.addEventListener("keydown", (event) => this.#pressed(event));
    const button = (text, name, act) => h("button", { type: "button", title: name, "aria-label": name, onclick: act }, text);
    const turn = (right, up) => () => this.#scene.turn(right * TURN, up * TURN);
    this.stage.append(
      h(
        "div",
        { class: "stage-buttons", role: "group", "aria-label": "View" },
        button("←", "View from further left", turn(-1, 0)),
        button("→", "View from further right", turn(1, 0)),
        button("↑", "View from higher", turn(0, 1)),
        button("↓", "View from lower", turn(0, -1)),
        button("+", "Zoom in", () => this.#scene.turn(0, 0, NEARER)),
        button("−", "Zoom out", () => this.#scene.turn(0, 0, 1 / NEARER)),
        button("⟲", "Reset view", () => this.#scene.reset()),
      ),
    );
  }

  #pressed(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const zooms = { "+": NEARER, "=": NEARER, "-": 1 / NEARER };
    if (turns[event.key]) this.#scene.turn(...turns[event.key].map((each) => each * TURN));
    else if (zooms[event.key]) this.#scene.turn(0, 0, zooms[event.key]);
    else if (event.key === "0" || event.key === "Home") this.#scene.reset();
    else return;
    event.preventDefault();
  }

  #switch(text, on, changed) {
    const box = h("input", { type: "checkbox", checked: on, onchange: () => (this.#draw(), changed?.()) });
    return { box, label: h("label", {}, box, " ", text) };
  }

  // What the service says.

  /** The table has changed: ask again after a pause. */
  changed() {
    this.#sweep = null;
    clearTimeout(this.#timer);
    this.element.setAttribute("aria-busy", true);
    this.#timer = setTimeout(() => this.#refresh(), AFTER_A_KEY);
  }

  /** Have the next picture shown whole. */
  refit() {
    this.#refit = true;
  }

  /** Forget the numbers of joints and symbols: they belong to another robot. */
  forget() {
    this.#values = {};
    this.#symbols = {};
    this.#hidden.clear();
  }

  async #request(sets, body = this.host.body()) {
    this.#busy(1);
    try {
      return await this.host.service.frames({ ...body, symbols: this.#symbols, ...(sets ? { joints: sets } : {}) });
    } finally {
      this.#busy(-1);
    }
  }

  /** Say to whoever cannot see it that the picture is about to change. */
  #busy(step) {
    this.#pending += step;
    this.element.setAttribute("aria-busy", this.#pending > 0);
  }

  /** Ask for the picture at the joint values as they are. */
  async #refresh() {
    const turn = ++this.#turn;
    const body = this.host.body();
    this.#dragging = false;
    this.#busy(0);
    if (!body) return this.#show(null);
    try {
      const values = this.#answer && this.#current;
      const answer = await this.#request(values && this.#isSame(body) ? [values] : null);
      if (turn !== this.#turn || this.#closed) return undefined;
      const missing = answer.joints.some(({ variable }) => !(variable in this.#values));
      this.#remember(answer, body);
      // Joint values that were moved before the joints changed are asked for once more.
      if (!missing && !(values && this.#isSame(body)) && this.#moved(answer)) return this.#refresh();
      this.#show(answer);
    } catch (error) {
      if (turn !== this.#turn || this.#closed) return undefined;
      this.told.replaceChildren(...message(error.message));
      if (error.kind !== "refused") this.#timer = setTimeout(() => this.#refresh(), RETRY);
    }
    return undefined;
  }

  #isSame(body) {
    return this.structure === (body.table?.structure ?? body.exercise);
  }

  #remember(answer, body) {
    this.structure = body.table?.structure ?? body.exercise;
    this.#answer = answer;
    for (const { variable, home } of answer.joints) this.#values[variable] ??= home;
    this.host.answered?.(answer);
  }

  #moved(answer) {
    return answer.joints.some(({ variable, home }) => this.#values[variable] !== home);
  }

  get #current() {
    return this.#answer.joints.map(({ variable }) => this.#values[variable]);
  }

  #show(answer) {
    this.#answer = answer;
    this.element.classList.toggle("empty", !answer);
    if (!answer) return;
    this.picture = pictureOf(answer);
    this.#showSliders();
    this.#showSymbols();
    this.#showFrameSwitches();
    this.#showTold();
    this.over.hidden = !(answer.mechanism && answer.table);
    this.#showScene();
    this.#showNumbers();
  }

  #showScene() {
    if (!this.#scene) return;
    const { joints, mechanism } = this.#answer;
    const { frames } = this.picture;
    const convention = this.host.body().table?.convention ?? "standard";
    // The sizes of parts stay while joints move.
    const subject = {
      joints,
      convention,
      size: mechanism?.size ?? sizeOf(frames ?? []),
      azimuth: mechanism?.azimuth ?? -60,
      elevation: mechanism?.elevation ?? 25,
      solid: !mechanism,
      beside: () => this.beside.box.checked,
      robot: () => this.robot.box.checked || !frames,
      shown: (i) => !this.#hidden.has(i),
    };
    this.#scene.show(subject, this.picture);
    if (this.#refit) this.#scene.reset();
    this.#refit = false;
  }

  // Joints.

  #showSliders() {
    const names = JSON.stringify(this.#answer.joints.map(({ home, ...joint }) => joint));
    if (this.sliderNames !== names) {
      this.sliderNames = names;
      this.sliders.replaceChildren(...this.#answer.joints.map((joint, i) => this.#slider(joint, i)));
    }
    this.#answer.joints.forEach((joint, i) => this.#showValue(i));
  }

  #slider({ joint, variable, kind, low, high }, i) {
    const doing = kind === "P" ? "slides" : "turns";
    const prepare = () => this.#prepare(i);
    const field = h("input", {
      type: "range",
      min: low,
      max: high,
      step: (high - low) / STEPS,
      "aria-label": `${variable}: joint ${joint} ${doing}`,
      oninput: (event) => this.#dragged(i, Number(event.target.value)),
      onchange: () => this.#refresh(),
      onpointerdown: prepare,
      onfocus: prepare,
    });
    return h("div", { class: "slider" }, h("span", { class: "name", "aria-hidden": "true" }, symbolName(variable)), field, h("output", {}));
  }

  #showValue(i) {
    const { variable, kind } = this.#answer.joints[i];
    const value = this.#values[variable];
    const row = this.sliders.children[i];
    const text = kind === "P" ? decimal(value) : `${Math.round(value * DEGREES)}°`;
    row.querySelector("output").textContent = text;
    const field = row.querySelector("input");
    field.setAttribute("aria-valuetext", text);
    if (!field.matches(":active") && Number(field.value) !== value) field.value = value;
  }

  /** Fetch the sweep of a joint, unless it is there. */
  #prepare(i) {
    if (!this.#answer) return;
    const values = this.#current;
    const others = JSON.stringify([this.host.body(), this.#symbols, values.with(i, 0)]);
    if (this.#sweep?.index === i && this.#sweep.others === others) return;
    const sweep = new Sweep((sets) => this.#request(sets, withoutFormulas(this.host.body())), values, i, this.#answer.joints[i]);
    sweep.others = others;
    this.#sweep = sweep;
    // A picture at the very place where the slider was left is better than one from the sweep.
    sweep.load(() => sweep === this.#sweep && this.#dragging && this.#follow()).catch(() => sweep === this.#sweep && (this.#sweep = null));
  }

  #dragged(i, value) {
    if (!this.#answer) return;
    this.#values[this.#answer.joints[i].variable] = value;
    this.#turn += 1;
    this.#dragging = true;
    this.#showValue(i);
    this.#prepare(i);
    this.#follow();
  }

  /** Draw the joint that is moved where its slider is. */
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
    this.host.announce?.("Home configuration");
  }

  #draw() {
    if (this.picture) this.#scene?.move(this.picture);
  }

  // Symbols, frames and numbers.

  #showSymbols() {
    const { symbols } = this.#answer;
    const names = Object.keys(symbols);
    this.more.hidden = names.length === 0;
    if (this.lengths.dataset.names !== names.join(" ")) {
      this.lengths.dataset.names = names.join(" ");
      this.lengths.replaceChildren(...names.map((name) => this.#symbolField(name)));
    }
    for (const field of this.lengths.querySelectorAll("input")) {
      if (!field.matches(":focus")) field.value = decimal(symbols[field.name]);
    }
  }

  #symbolField(name) {
    const described = this.host.descriptions?.[name];
    const changed = (event) => {
      const value = event.target.valueAsNumber;
      if (!Number.isFinite(value) || Math.abs(value) > 1e6) return;
      this.#symbols = { ...this.#symbols, [name]: value };
      this.changed();
    };
    const field = h("input", { type: "number", step: 0.05, name, oninput: changed, "aria-label": described ? `${name}: ${visible(described)}` : name });
    return h("label", { title: described ? visible(described) : null }, h("span", { class: "name", "aria-hidden": "true" }, symbolName(name)), field);
  }

  #showFrameSwitches() {
    const count = this.picture.frames?.length ?? 0;
    if (this.frames.children.length === (count ? count + 1 : 0)) return;
    const toggle = (i, on) => (on ? this.#hidden.delete(i) : this.#hidden.add(i), this.#draw());
    const boxes = Array.from({ length: count }, (_, i) => {
      const box = h("input", { type: "checkbox", checked: !this.#hidden.has(i), "aria-label": `Show frame ${i}`, onchange: (event) => toggle(i, event.target.checked) });
      return h("label", {}, box, ` {${i}}`);
    });
    const legend = h("span", { class: "legend" }, "Frames ", ...["x", "y", "z"].map((axis) => h("i", { class: axis }, axis)));
    this.frames.replaceChildren(...(count ? [legend, ...boxes] : []));
  }

  #showTold() {
    const { table } = this.#answer;
    const [cell] = table?.unread ?? [];
    const place = cell ? `Row ${cell.row}, ${cell.column}: ` : "";
    const reason = table?.error?.message ?? (cell && `${place}${cell.error.message}`);
    const lost = table?.lost_freedoms.map((each) => each.message) ?? [];
    const ends = reason && table.frames[0]?.length ? " The frames end before it." : "";
    this.told.replaceChildren(...message([reason && reason + ends, ...lost].filter(Boolean).join(" ")));
    this.told.hidden = !this.told.textContent;
  }

  #showNumbers() {
    const { frames, mechanism } = this.picture;
    const lines = [];
    if (mechanism) lines.push(["Tool of the robot", mechanism.tool]);
    if (frames?.length > 1) lines.push([`Origin of your frame {${frames.length - 1}}`, column(frames.at(-1), 3)]);
    if (this.numbers.children.length !== lines.length) this.numbers.replaceChildren(...lines.map(() => h("p", {}, h("span"), h("code"))));
    lines.forEach(([name, point], i) => {
      const [label, value] = this.numbers.children[i].children;
      label.textContent = name;
      value.textContent = point.map(decimal).join("  ");
    });
    this.host.moved?.(this.picture, this.#values);
  }
}

/** A sweep needs numbers only. */
function withoutFormulas({ table, ...body }) {
  return table ? { ...body, table: { ...table, formulas: false } } : body;
}

/** Three decimals, without a negative zero. */
function decimal(value) {
  return (Math.round(value * 1000) / 1000 + 0).toFixed(3).replace(/^-(0\.000)$/, "$1");
}

/** A size for the parts of a chain without a mechanism. */
function sizeOf(frames) {
  const origins = frames.map((frame) => column(frame, 3));
  const spans = [0, 1, 2].map((i) => Math.max(0, ...origins.map((each) => each[i])) - Math.min(0, ...origins.map((each) => each[i])));
  return 0.9 * Math.hypot(...spans) || 1;
}
