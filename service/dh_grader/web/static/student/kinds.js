// The kinds of answers: each kind has grids of cells, and JSON for its answers. The shape of a part (from
// GET /v1/exercises/{id}) describes the grids. The rows of all grids of a part form one list, with the same
// labels as in reports.

import { worded } from "../shared/words/words.js";

/** @type {Record<string, Api.Quantity>} */
const QUANTITIES = { a: "length", alpha: "angle", d: "length", theta: "angle" };
/** @type {Record<string, string>} */
export const SPOKEN = {
  a: worded("a, link length"),
  alpha: worded("alpha, link twist"),
  d: worded("d, link offset"),
  theta: worded("theta, joint angle"),
};
/** @type {Record<string, string>} */
export const LETTERS = { a: "a", alpha: "α", d: "d", theta: "θ" };

/** @type {Record<string, Omit<Front.Column, "label">>} */
const FRAME_COLUMNS = {
  axis: { head: worded("axis"), spoken: worded("joint axis along which z lies"), quantity: "number" },
  z: { head: "z", spoken: worded("direction of z"), quantity: "number" },
  origin_x: { head: "o", index: "x", spoken: worded("x of the origin"), quantity: "length" },
  origin_y: { head: "o", index: "y", spoken: worded("y of the origin"), quantity: "length" },
  origin_z: { head: "o", index: "z", spoken: worded("z of the origin"), quantity: "length" },
  x: { head: "x", spoken: worded("direction of x"), quantity: "number" },
};
const DIRECTIONS = ["+x", "-x", "+y", "-y", "+z", "-z"];

/** @template Value @param {Value[]} values @param {number} size */
const chunks = (values, size) =>
  Array.from({ length: Math.ceil(values.length / size) }, (_, i) => values.slice(i * size, (i + 1) * size));

/**
 * Return the layout of a part: `grids`, each with `title`, `look`, `columns` and `rows`; `choices`, the names of the
 * options beside the cells by value; `answer(texts, choice)`, which converts all texts in order to JSON.
 *
 * @param {Pick<Api.Part, "kind" | "shape">} part
 * @returns {Front.Layout}
 */
export function layoutOf(part) {
  // The function of a form takes shapes of this form.
  const form = /** @type {(shape: Api.Part["shape"], kind: string) => Front.Layout} */ (FORMS[part.shape.form]);
  return form(part.shape, part.kind);
}

const FORMS = {
  /** @param {Api.DhTableShape} shape @returns {Front.Layout} */
  dh_table(shape) {
    const either = shape.convention === "either";
    return {
      grids: [{
        title: "",
        look: "table",
        columns: parameters(shape),
        rows: shape.rows.map((label) => ({
          ...row(label, label === "e" ? worded("e, end effector") : label),
          prefill: shape.given?.[label],
          isGiven: Boolean(shape.given?.[label]),
        })),
      }],
      choices: either
        ? {
          "": worded("Convention: not specified"),
          standard: worded("Convention: standard (distal)"),
          modified: worded("Convention: modified (proximal)"),
        }
        : null,
      answer: (texts, choice) => ({
        rows: chunks(texts, shape.columns.length).map((values) => named(shape.columns, values)),
        ...(choice ? { convention: choice } : {}),
      }),
    };
  },

  /** @param {Api.FramesShape} shape @returns {Front.Layout} */
  frames(shape) {
    return {
      grids: [{
        title: "",
        look: "table",
        columns: shape.columns.map((label) => ({
          label,
          ...FRAME_COLUMNS[label],
          offers: label === "axis" ? shape.joints : label === "z" || label === "x" ? DIRECTIONS : undefined,
        })),
        hasNamedRows: true,
        rows: shape.rows.map((label) => row(label, worded("frame {frame}", { frame: label }), `{${label}}`)),
      }],
      choices: null,
      answer: (texts) =>
        chunks(texts, shape.columns.length).map(([axis, z, ox, oy, oz, x], i) => (
          { frame: shape.rows[i], axis, z, origin: [ox, oy, oz], x }
        )),
    };
  },

  /** @param {Api.FindSlipShape} shape @returns {Front.Layout} */
  find_slip(shape) {
    const given = shape.given ?? [];
    const rows = shape.rows.map((label, i) => ({
      ...row(label, label === "e" ? worded("e, end effector") : label),
      prefill: given[i],
    }));
    return {
      grids: [{ title: worded("The mended table"), look: "table", columns: parameters(shape), rows }],
      choices: null,
      marks: given,
      answer: (texts, marked) => ({
        ...(marked ? { marked } : {}),
        ...(texts.some((text) => text !== "")
          ? { table: { rows: chunks(texts, shape.columns.length).map((values) => named(shape.columns, values)) } }
          : {}),
      }),
    };
  },

  /** @param {Api.DhRowShape} shape @returns {Front.Layout} */
  dh_row(shape) {
    return {
      grids: [{ title: "", look: "table", columns: parameters(shape), rows: [row("1", "")] }],
      choices: { "": worded("It has this row:"), none: worded("It has no DH row") },
      answer: (texts, choice) => (choice === "none" ? { none: true } : named(shape.columns, texts)),
    };
  },

  /** @param {Api.LinkTransformsShape} shape @returns {Front.Layout} */
  link_transforms(shape) {
    /** @type {Front.Grid[]} */
    const grids = shape.matrices.map((name) => ({
      title: name,
      help: screenOf(shape.convention, "link-transform"),
      look: "matrix",
      columns: numbered(shape.columns),
      rows: shape.rows.map((label, i) => ({
        ...row(`${name}.${label}`, worded("{matrix} row {row}", { matrix: name, row: label }), label),
        prefill: prefilled(shape, i),
      })),
    }));
    const width = shape.columns.length;
    return { grids, choices: null, answer: (texts) => chunks(chunks(texts, width), shape.rows.length) };
  },

  /** @param {Api.MatrixShape} shape @returns {Front.Layout} */
  matrix(shape) {
    const rows = shape.rows.map((label, i) => ({
      ...row(label, worded("row {row}", { row: label })),
      prefill: prefilled(shape, i),
    }));
    return {
      grids: [{ title: "", look: "matrix", columns: numbered(shape.columns), rows }],
      choices: null,
      answer: (texts) => chunks(texts, shape.columns.length),
    };
  },

  /** @param {Api.ListShape} shape @param {string} kind @returns {Front.Layout} */
  list(shape, kind) {
    const rows = shape.components.map(({ name, quantity }, i) => ({
      ...row(shape.rows[i], name, name),
      quantity,
    }));
    const letter = kind === "euler_angles" ? worded("angle") : worded("value");
    return {
      grids: [{
        title: "",
        look: "list",
        columns: [{ label: "1", head: letter, spoken: "", quantity: "number" }],
        rows,
      }],
      choices: null,
      answer: (texts) => texts,
    };
  },

  /** @param {Api.ScrewAxesShape} shape @returns {Front.Layout} */
  screw_axes(shape) {
    const heads = ["ω₁", "ω₂", "ω₃", "v₁", "v₂", "v₃"];
    const letter = shape.frame === "body" ? "B" : "S";
    /** @type {Front.Column[]} */
    const columns = shape.columns.map((label, i) => ({ label, head: heads[i], spoken: heads[i], quantity: "number" }));
    return {
      grids: [{
        title: "",
        look: "table",
        columns,
        rows: shape.rows.map((label) => row(label, `${letter}${label}`, `${letter}${label}`)),
      }],
      choices: null,
      answer: (texts) => chunks(texts, columns.length),
    };
  },
};

/**
 * Return the texts that the form fills into a row: the last row of a homogeneous matrix is always the same.
 *
 * @param {{ rows: string[], columns: string[] }} shape
 * @param {number} i
 */
const prefilled = ({ rows, columns }, i) =>
  rows.length === 4 && columns.length === 4 && i === 3 ? ["0", "0", "0", "1"] : undefined;

/**
 * Return the columns of a DH table. In the modified convention, a and α have the index i−1.
 *
 * @param {{ columns: string[], convention: string }} shape
 * @returns {Front.Column[]}
 */
function parameters(shape) {
  const before = shape.convention === "modified" ? "i−1" : "i";
  return shape.columns.map((label) => ({
    label,
    head: LETTERS[label],
    index: label === "a" || label === "alpha" ? before : "i",
    spoken: SPOKEN[label],
    quantity: QUANTITIES[label],
    help: screenOf(shape.convention, label),
  }));
}

/** Return the address of a place in *DH in ten minutes*. @param {string} convention @param {string} place */
const screenOf = (convention, place) =>
  `learn-dh?convention=${convention === "modified" ? "modified" : "standard"}#${place}`;

/** @param {string} label @param {string} spoken @param {string} [head] @returns {Front.Row} */
const row = (label, spoken, head = label) => ({ label, spoken, head });

/** @param {string[]} labels @returns {Front.Column[]} */
const numbered = (labels) =>
  labels.map((label) => ({
    label,
    head: label,
    spoken: worded("column {column}", { column: label }),
    quantity: "number",
  }));

/** @param {string[]} columns @param {string[]} values */
const named = (columns, values) => Object.fromEntries(columns.map((column, i) => [column, values[i]]));
