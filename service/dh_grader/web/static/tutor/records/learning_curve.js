// A small chart of the share of learners with a misconception in their first attempt, second attempt, and so on.

import { make } from "./days_chart.js";
import { percent } from "./records.js";
import { worded } from "../../shared/words/words.js";

const WIDTH = 120;
const HEIGHT = 36;
const MARGIN = 5;

/**
 * Return the chart, with its numbers as text; null if nobody made a second attempt.
 *
 * @param {number[]} having the learners with the misconception, by attempt
 * @param {number[]} all all learners, by attempt
 */
export function learningCurve(having, all) {
  const shares = all.map((count, i) => (having[i] ?? 0) / count);
  if (shares.length < 2) return null;
  const step = (WIDTH - 2 * MARGIN) / (shares.length - 1);
  const points = shares.map((share, i) => [MARGIN + i * step, HEIGHT - MARGIN - share * (HEIGHT - 2 * MARGIN)]);
  const told = shares.map((share, i) =>
    worded("attempt {number}: {share} of {all}", { number: i + 1, share: percent(share), all: all[i] })
  ).join(", ");
  const size = { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT };
  const drawn = make("svg", { ...size, role: "img", "aria-label": told, class: "curve" });
  const title = make("title", {});
  title.textContent = told;
  drawn.append(
    title,
    make("path", { d: `M0 ${HEIGHT - MARGIN}H${WIDTH}`, class: "ground" }),
    make("polyline", { points: points.map((each) => each.join(",")).join(" "), class: "line" }),
    ...points.map(([x, y]) => make("circle", { cx: x, cy: y, r: 2 })),
  );
  return drawn;
}
