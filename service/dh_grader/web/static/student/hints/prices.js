// The prices of hints at a report on submitted answers.

import { number } from "../../shared/dom.js";
import { worded } from "../../shared/words/words.js";

/**
 * Return the prices of the hints at the report on an attempt, or null if these hints have no prices.
 *
 * @param {Front.HintHost["handIn"]} handIn
 * @param {string} attempt
 * @returns {Front.HintPrices | null}
 */
export function pricesOf(handIn, attempt) {
  if (!handIn || !attempt) return null;
  const { hint_prices: prices, hints = [], points } = handIn.own.exercise;
  return prices ? { attempt, prices, taken: hints, points } : null;
}

/**
 * Return the price of a step in words; an empty text if the step costs nothing.
 *
 * @param {Front.HintPrices} offer
 * @param {Front.Topic & { part: string }} topic
 * @param {number} step
 */
export function priceInWords({ prices, taken, points }, topic, step) {
  const isTaken = taken.some((each) =>
    each.step === step && each.part === topic.part && each.row === topic.row && each.cell === topic.cell
  );
  if (isTaken) return worded("you have taken it");
  const price = prices[step - 1];
  return price
    ? worded("costs {price} of {points} points of each later attempt", {
      price: number(price * points),
      points: number(points),
    })
    : "";
}

/** @param {Front.HintPrices | null} prices */
export const tryFirst = (prices) =>
  prices
    ? worded("Change your answer and hand it in again. Then the next hint opens.")
    : worded("Change your answer and check it again. Then the next hint opens.");
