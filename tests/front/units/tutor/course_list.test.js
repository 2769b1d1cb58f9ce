// The encodings of class lists.

import assert from "node:assert/strict";
import test from "node:test";

import { pieces, textOf } from "../../../../service/dh_grader/web/static/tutor/courses/course_forms.js";

/** @param {number[]} bytes */
const read = (...bytes) => textOf(new Uint8Array(bytes).buffer);

test("a class list in an encoding of spreadsheets", () => {
  assert.equal(read(0x5a, 0x6f, 0xc3, 0xab), "Zoë");
  assert.equal(read(0xef, 0xbb, 0xbf, 0x5a, 0x6f, 0xc3, 0xab), "Zoë");
  assert.equal(read(0x5a, 0x6f, 0xeb), "Zoë");
  assert.equal(read(0xff, 0xfe, 0x5a, 0, 0x6f, 0, 0xeb, 0), "Zoë");
  assert.equal(read(0xfe, 0xff, 0, 0x5a, 0, 0x6f, 0, 0xeb), "Zoë");
});

test("a short class list is sent as it is", () => {
  const text = 'id,name\r\n1,"Ada\nLovelace"\r\n\r\n2,Grace\r\n';
  assert.deepEqual(pieces(text), [text]);
});

test("a long class list is sent in pieces with the headings, and with the places of its lines", () => {
  const people = Array.from({ length: 5000 }, (_, i) => `${i},"Ada ""${i}""\n Lovelace",ada${i}@student.example.edu`);
  const found = pieces(["id,name,email", ...people].join("\n"));
  assert.ok(found.length > 4 && found.every((piece) => JSON.stringify(piece).length < 100_000));
  let records = 0;
  for (const piece of found) {
    const [head, ...rest] = piece.split(/\n(?! )/u);
    assert.equal(head, "id,name,email");
    const first = rest.findIndex(Boolean);
    assert.equal(first, records);
    assert.deepEqual(rest.slice(first), people.slice(first, rest.length));
    records = rest.length;
  }
  assert.equal(records, people.length);
});

test("a class list with many columns is sent in pieces", () => {
  const found = pieces("id,name\n" + `1,Ada${",".repeat(100)}\n`.repeat(500));
  assert.ok(found.length > 3 && found.every((piece) => piece.split(",").length < 20_000));
});
