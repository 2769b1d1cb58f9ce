// Dates of an assignment on the clocks of the course and, if they differ, of the learner.

import { language, worded } from "../../shared/words/words.js";

/** @type {Intl.DateTimeFormatOptions} */
const CLOCK = { weekday: "short", day: "numeric", month: "short", year: "numeric", hour: "2-digit", minute: "2-digit" };

/**
 * Return a moment on the clocks of a time zone, such as "Thu, 15 Oct 2026, 23:59".
 *
 * @param {Date} date
 * @param {string | undefined} zone by default the browser's time zone
 * @param {Intl.DateTimeFormatOptions} [more]
 */
function clock(date, zone, more = {}) {
  const seconds = date.getUTCSeconds() ? { second: /** @type {const} */ ("2-digit") } : {};
  return new Intl.DateTimeFormat(language === "en" ? "en-GB" : language, {
    ...CLOCK,
    ...seconds,
    ...more,
    timeZone: zone,
  }).format(date);
}

/**
 * Return a moment in the course's time zone, and in brackets in the learner's time zone if the time there differs.
 *
 * @param {string} moment
 * @param {string} zone
 * @param {string} [own] by default the browser's time zone
 */
export function momentIn(moment, zone, own) {
  const date = new Date(moment);
  const named = clock(date, zone, { timeZoneName: "short" });
  const mine = clock(date, own, { year: undefined });
  return mine === clock(date, zone, { year: undefined })
    ? named
    : worded("{moment} ({own} in your time zone)", { moment: named, own: mine });
}
