// The kinds of answers: which grids of cells one has, and the JSON that its cells are posted as.
// A part is described by its shape (GET /v1/exercises/{id}); the cells of all its grids are one list
// of rows, each with the label that it has in a report.

const QUANTITIES = { a: "length", alpha: "angle", d: "length", theta: "angle" };
const SPOKEN = { a: "a, link length", alpha: "alpha, link twist", d: "d, link offset", theta: "theta, joint angle" };
const LETTERS = { a: "a", alpha: "α", d: "d", theta: "θ" };

const chunks = (values, size) =>
  Array.from({ length: Math.ceil(values.length / size) }, (_, i) => values.slice(i * size, (i + 1) * size));

/**
 * The layout of a part: `grids`, each with `title`, `look`, `columns` and `rows`; `answer(texts, choice)` makes the
 * JSON of all texts in order; `choices` are the options beside the cells, by value.
 */
export function layoutOf(part) {
  return FORMS[part.shape.form](part.shape, part.kind);
}

const FORMS = {
  dh_table(shape) {
    const either = shape.convention === "either";
    return {
      grids: [{
        title: "",
        look: "table",
        columns: parameters(shape),
        rows: shape.rows.map((label) => row(label, label === "e" ? "e, end effector" : label)),
      }],
      choices: either
        ? {
          "": "Convention: not said",
          standard: "Convention: standard (distal)",
          modified: "Convention: modified (proximal)",
        }
        : null,
      answer: (texts, choice) => ({
        rows: chunks(texts, shape.columns.length).map((values) => named(shape.columns, values)),
        ...(choice ? { convention: choice } : {}),
      }),
    };
  },

  dh_row(shape) {
    return {
      grids: [{ title: "", look: "table", columns: parameters(shape), rows: [row("1", "")] }],
      choices: { "": "It has this row:", none: "It has no DH row" },
      answer: (texts, choice) => (choice === "none" ? { none: true } : named(shape.columns, texts)),
    };
  },

  link_transforms(shape) {
    const grids = shape.matrices.map((name) => ({
      title: name,
      look: "matrix",
      columns: numbered(shape.columns),
      rows: shape.rows.map((label) => row(`${name}.${label}`, `${name} row ${label}`, label)),
    }));
    const width = shape.columns.length;
    return { grids, choices: null, answer: (texts) => chunks(chunks(texts, width), shape.rows.length) };
  },

  matrix(shape) {
    const rows = shape.rows.map((label) => row(label, `row ${label}`));
    return {
      grids: [{ title: "", look: "matrix", columns: numbered(shape.columns), rows }],
      choices: null,
      answer: (texts) => chunks(texts, shape.columns.length),
    };
  },

  list(shape, kind) {
    const rows = shape.components.map(({ name, quantity }, i) => ({
      ...row(shape.rows[i], name, name),
      quantity,
    }));
    const letter = kind === "euler_angles" ? "angle" : "value";
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

  screw_axes(shape) {
    const heads = ["ω₁", "ω₂", "ω₃", "v₁", "v₂", "v₃"];
    const letter = shape.frame === "body" ? "B" : "S";
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

/** The columns of a DH table; in the modified convention a and α have the index before the row's. */
function parameters(shape) {
  const before = shape.convention === "modified" ? "i−1" : "i";
  return shape.columns.map((label) => ({
    label,
    head: LETTERS[label],
    index: label === "a" || label === "alpha" ? before : "i",
    spoken: SPOKEN[label],
    quantity: QUANTITIES[label],
  }));
}

const row = (label, spoken, head = label) => ({ label, spoken, head });

const numbered = (labels) =>
  labels.map((label) => ({ label, head: label, spoken: `column ${label}`, quantity: "number" }));

const named = (columns, values) => Object.fromEntries(columns.map((column, i) => [column, values[i]]));
