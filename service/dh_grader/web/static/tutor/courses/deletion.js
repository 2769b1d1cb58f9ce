// Deletions on the pages of courses: first the service says what would be deleted, then a second button deletes it.

import { h } from "../../shared/dom.js";
import { language, worded, wordedFor } from "../../shared/words/words.js";
import { failed, tell } from "../records/records.js";
import { address, send } from "../tutor_service.js";

/**
 * Return in words what a deletion deletes.
 *
 * @param {Api.DeletedData} data
 */
export function inWords({ assignments, learners, extensions, keys, attempts }) {
  const told = [
    assignments && wordedFor("{count} assignment", "{count} assignments", assignments),
    learners && wordedFor("the place of {count} learner", "the place of {count} learners", learners),
    extensions && wordedFor("{count} extension", "{count} extensions", extensions),
    keys && wordedFor("{count} link", "{count} links", keys),
    attempts &&
    wordedFor("{count} attempt with answers and reports", "{count} attempts with answers and reports", attempts, {
      count: attempts.toLocaleString(language),
    }),
  ];
  return told.filter(Boolean).join(", ") || worded("nothing else");
}

/** @param {HTMLElement} place */
function offer(place) {
  const { delete: path = "", learner, what = "", then = "" } = place.dataset;
  // The attempts of a removed learner stay, and count again if the learner comes back.
  const keepsAttempts = learner !== undefined;
  const body = learner === undefined ? {} : { learner };
  const state = h("p", { role: "status", class: "state-line" });
  const ask = h("button", { type: "button", onclick: preview }, worded("Delete {what} …", { what }));
  const final = h("button", { type: "button", class: "danger", onclick: remove }, worded("Delete permanently"));
  const cancel = h("button", { type: "button", onclick: () => shown(false) }, worded("Cancel"));
  let withAttempts = false;

  /** @param {boolean} isAsked */
  function shown(isAsked) {
    ask.hidden = isAsked;
    final.hidden = cancel.hidden = !isAsked;
    if (!isAsked) tell(state, "");
    (isAsked ? cancel : ask).focus();
  }

  async function preview() {
    try {
      const found = await send(path, body);
      withAttempts = found.attempts > 0 && !keepsAttempts;
      shown(true);
      const kept = keepsAttempts
        ? wordedFor(
          "{count} attempt of this learner will stay.",
          "{count} attempts of this learner will stay.",
          found.attempts,
        )
        : "";
      const gone = inWords(keepsAttempts ? { ...found, attempts: 0 } : found);
      const told = worded("This deletes {what}: {gone}. It cannot be undone.", { what, gone });
      tell(state, kept ? `${told} ${kept}` : told);
    } catch (error) {
      failed(error, state);
    }
  }

  async function remove() {
    try {
      await send(path, { ...body, apply: true, with_attempts: withAttempts });
      location.assign(address(then));
    } catch (error) {
      failed(error, state);
    }
  }

  final.hidden = cancel.hidden = true;
  place.append(h("p", { class: "choices" }, ask, final, cancel), state);
}

if (typeof document !== "undefined") {
  for (const place of document.querySelectorAll("[data-delete]")) if (place instanceof HTMLElement) offer(place);
}
