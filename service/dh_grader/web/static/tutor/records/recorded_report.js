// A recorded submission with its report, as the student saw them. Both are read-only.

import { h, visible } from "../../shared/dom.js";
import { cellsOf } from "../../student/handin/answer_cells.js";
import { lostItems } from "../../student/report/lost_points.js";
import { item } from "../../student/messages.js";
import { PartView } from "../../student/part_view.js";
import { Previewer } from "../../student/previewer.js";
import { earnedInWords, verdictName } from "../../shared/words/phrases.js";
import { worded } from "../../shared/words/words.js";
import { send } from "../tutor_service.js";
import { playedTable } from "../../student/report/played_table.js";

const SHEETS = ["../../shared/tokens.css", "../../student/element.css", "./recorded.css"].map((name) =>
  new URL(name, import.meta.url).href
);

/** @type {Front.PreviewService} */
const TUTORS = {
  previews: (body) => send("v1/previews", body),
  preview: (body) => send("v1/preview", body),
  frames: (body) => send("v1/frames", body),
};

/** A part whose cells are read-only. */
class RecordedPart extends PartView {
  // Resolves to true if the answer fits into the cells.
  /** @type {Promise<boolean> | undefined} */
  filled;

  /** @param {Api.Part} part @param {Front.PartHost} host */
  constructor(part, host) {
    super(part, host, "h2");
    this.reading.remove();
    if (this.choice) this.choice.disabled = true;
    this.marks?.lock();
    for (const cell of this.cells) {
      cell.input.readOnly = true;
      cell.repair = (suggestion) => h("span", { class: "quiet" }, "→ ", h("bdi", {}, visible(suggestion)));
    }
  }

  /** @override */
  pasted() {
    return Promise.resolve();
  }

  /** @override */
  beforeInput() {}

  /** @override */
  repaired() {}
}

/** @typedef {{ answers?: Record<string, unknown>, angle_unit?: Api.AngleUnit }} Submission */

/** A submission with one of its reports. */
export class RecordedReport {
  /**
   * `exercise` is the exercise as students see it, or null if it no longer exists. `service` reads entries.
   *
   * @param {Api.Exercise | null} exercise
   * @param {Submission} submission
   * @param {Front.PreviewService} service
   */
  constructor(exercise, submission, service = TUTORS) {
    this.exercise = exercise;
    this.submission = submission;
    /** @type {() => Front.Context} */
    const context = () => ({ exercise: exercise?.id ?? "", angle_unit: submission.angle_unit ?? "radians" });
    // The host of the parts, with all that they need.
    /** @type {Front.PartHost} */
    this.host = {
      service,
      context,
      previewer: new Previewer(service, context, () => {}),
      history: { note() {}, undo: () => null, redo: () => null },
      announce() {},
      edited() {},
      check() {},
      failed() {},
    };
    this.parts = new Map((exercise?.parts ?? []).map((part) => [part.id, new RecordedPart(part, this.host)]));
    this.body = h("div", { class: "parts" });
    this.element = h("div", { class: "recorded" });
    this.element.attachShadow({ mode: "open" }).append(
      ...SHEETS.map((href) => h("link", { rel: "stylesheet", href })),
      this.body,
    );
  }

  /**
   * Show a report. Parts that the exercise no longer has are shown without cells.
   *
   * @param {Api.Report} report
   */
  show(report) {
    this.body.replaceChildren(...report.parts.map((part) => this.#part(part)));
  }

  /** @param {Api.PartReport} report */
  #part(report) {
    const view = this.parts.get(report.part);
    const answer = this.submission.answers?.[report.part];
    const element = view?.element ?? bare(report);
    if (view) {
      // Filling the cells removes their verdicts, so show the report after that.
      view.filled ??= this.#fill(view, answer);
      view.filled.then((isFilled) => {
        view.showReport(report);
        element.classList.toggle("without-cells", !isFilled && !report.rows.length);
        if (isFilled && this.exercise) this.#play(this.exercise, view);
      });
    }
    const isLeftOut = answer === undefined || answer === null;
    element.classList.toggle("left-out", isLeftOut);
    if (!isLeftOut && !element.querySelector(".as-sent")) element.append(asSent(answer));
    return element;
  }

  /** Add a 3D view that plays the rows of a table. @param {Api.Exercise} exercise @param {RecordedPart} view */
  #play(exercise, view) {
    if (view.part.kind !== "dh_table" || view.isEmpty || view.element.querySelector(".played-table")) return;
    view.body.append(playedTable(exercise, view, this.host));
  }

  /**
   * Put the answer into the cells of its part. Return true if the answer fits.
   *
   * @param {RecordedPart} view
   * @param {unknown} answer
   */
  async #fill(view, answer) {
    const read = typeof answer === "string" ? await this.#entries(view.part.id, answer) : answer;
    const state = cellsOf(view.layout, read);
    if (state) view.restore(state);
    // The answer does not fit: unfold the answer as it was sent.
    else view.element.querySelector(".as-sent")?.toggleAttribute("open", true);
    return state !== null;
  }

  /**
   * Return the entries that the service reads in a table or matrix that was sent as one text.
   *
   * @param {string} part
   * @param {string} text
   */
  async #entries(part, text) {
    try {
      const { rows } = await this.host.service.preview({ ...this.host.context(), part, text });
      return rows?.map((row) => row.map(({ entry }) => entry)) ?? "";
    } catch {
      return "";
    }
  }
}

/**
 * Return the report on a part that the exercise no longer has.
 *
 * @param {Api.PartReport} report
 */
function bare(report) {
  const { part, verdict, points: earned, max_points: most, feedback, rows } = report;
  const messages = [
    ...feedback,
    ...rows.flatMap((row) => [...row.feedback, ...row.cells.flatMap((cell) => cell.feedback)]),
  ];
  const items = [...messages.map((each) => item(each, { verdict })), ...lostItems(report)];
  return h(
    "section",
    { class: "card part" },
    h(
      "header",
      {},
      h("h2", {}, visible(part)),
      h("span", { class: "badge", "data-verdict": verdict }, verdictName(verdict)),
      h("span", { class: "points" }, earnedInWords(earned, most)),
    ),
    h("p", { class: "quiet" }, worded("The exercise no longer has this part.")),
    h("ul", { class: "messages", hidden: !items.length }, ...items),
  );
}

/** @param {unknown} answer */
function asSent(answer) {
  const text = typeof answer === "string" ? answer : JSON.stringify(answer, null, 1);
  // Keep the line breaks; make all other invisible characters visible.
  const lines = text.split("\n").map(visible).join("\n");
  return h(
    "details",
    { class: "as-sent" },
    h("summary", {}, worded("As it was sent")),
    h("pre", { tabindex: 0 }, h("code", {}, lines)),
  );
}
