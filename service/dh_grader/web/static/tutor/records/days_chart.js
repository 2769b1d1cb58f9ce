// A small bar chart of counts by day, with its text alternative.

import { dayName } from "./records.js";
import { worded } from "../../shared/words/words.js";

const SVG = "http://www.w3.org/2000/svg";
const WIDTH = 160;
const HEIGHT = 28;
// The maximum number of bars. A chart of more days has several days in each bar.
const MOST_BARS = 40;
const DAY = 24 * 60 * 60 * 1000;
// The maximum number of days in the text alternative.
const MOST_SAID = 10;

/** @param {string} day */
const at = (day) => Date.parse(`${day}T00:00:00Z`);

/**
 * Return a map from each element of `all` (counts by day, such as 2026-11-22) to its chart. All charts show the same
 * days at the same scale.
 *
 * @param {Record<string, number>[]} all
 */
export function daysCharts(all) {
  const days = all.flatMap(Object.keys).sort();
  const first = at(days[0]);
  const span = Math.round((at(days[days.length - 1]) - first) / DAY) + 1;
  const width = Math.ceil(span / MOST_BARS);
  const bars = all.map((counts) => {
    const found = Array(Math.ceil(span / width)).fill(0);
    for (const [day, times] of Object.entries(counts)) found[Math.floor((at(day) - first) / DAY / width)] += times;
    return found;
  });
  const most = Math.max(...bars.flat());
  return new Map(all.map((counts, i) => [counts, chart(counts, bars[i], most)]));
}

/**
 * Return one chart; a bar for the count `most` has the full height.
 *
 * @param {Record<string, number>} counts
 * @param {number[]} bars
 * @param {number} most
 */
function chart(counts, bars, most) {
  const step = Math.min(WIDTH / bars.length, 16);
  const drawn = make("svg", {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    width: WIDTH,
    height: HEIGHT,
    role: "img",
    "aria-label": inWords(counts),
    class: "days",
  });
  drawn.append(make("path", { d: `M0 ${HEIGHT - 0.5}H${bars.length * step}`, class: "ground" }));
  bars.forEach((times, i) => {
    const height = times && Math.max((times / most) * (HEIGHT - 3), 2);
    if (times) {
      drawn.append(make("rect", { x: i * step + step * 0.1, y: HEIGHT - 1 - height, width: step * 0.8, height }));
    }
  });
  return drawn;
}

/** @param {Record<string, number>} counts */
function inWords(counts) {
  const days = Object.entries(counts);
  const most = days.toSorted((one, other) => other[1] - one[1]).slice(0, MOST_SAID).sort();
  const said = most.map(([day, times]) => `${dayName(day)}: ${times}`).join(", ");
  return days.length > most.length
    ? worded("most on {days}; {count} days in all", { days: said, count: days.length })
    : said;
}

/** @param {string} tag @param {Record<string, string | number>} attributes */
export function make(tag, attributes) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}
