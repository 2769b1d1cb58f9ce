import assert from "node:assert/strict";
import { test } from "node:test";
import { pieces } from "../../../service/dh_grader/web/static/typeset/names.js";
import file from "../../typeset/names.json" with { type: "json" };

const GREEK = new Map(
  [..."αalpha θtheta φphi πpi μmu ΓGamma λlambda ΩOmega ηeta τtau".split(" ")].map((each) => [each.slice(1), each[0]]),
);

/** @param {string | { stem: string, below: string, above: string }} piece */
const shown = (piece) =>
  typeof piece === "string" ? piece : `<${GREEK.get(piece.stem) ?? piece.stem}|${piece.below}|${piece.above}>`;

for (const [text, expected] of file.cases) {
  test(`the names of “${text}” are those that the service finds`, () => {
    assert.equal(pieces(text, new Set(file.symbols)).map(shown).join(""), expected);
  });
}
