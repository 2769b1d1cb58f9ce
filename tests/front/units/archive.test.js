import assert from "node:assert/strict";
import { test } from "node:test";
import { archiveOf, bytesOf, entries, textOf } from "../../../service/dh_grader/web/static/tutor/zip.js";

// Made by Python's zipfile: index.html is stored, zoë/report.html is deflated ("right " fifty times).
const ARCHIVE = [
  "UEsDBBQAAAAAAAAAIVx/ducWCQAAAAkAAAAKAAAAaW5kZXguaHRtbDxwPs64PC9wPlBLAwQUAAAICAAAACFcGLZRqAwAAAAsAQAAEAAAAHpvw6",
  "svcmVwb3J0Lmh0bWwrykzPKFEoGiWJIAFQSwECFAMUAAAAAAAAACFcf3bnFgkAAAAJAAAACgAAAAAAAAAAAAAAgAEAAAAAaW5kZXguaHRtbFBL",
  "AQIUAxQAAAgIAAAAIVwYtlGoDAAAACwBAAAQAAAAAAAAAAAAAACAATEAAAB6b8OrL3JlcG9ydC5odG1sUEsFBgAAAAACAAIAdgAAAGsAAAAAAA",
  "==",
].join("");

const bytes = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0)).buffer;

test("an archive has its files by name", () => {
  assert.deepEqual([...entries(bytes(ARCHIVE)).keys()], ["index.html", "zoë/report.html"]);
});

test("stored and deflated files are read", async () => {
  const archive = bytes(ARCHIVE);
  const found = entries(archive);
  assert.equal(await textOf(archive, found.get("index.html")), "<p>θ</p>");
  assert.equal(await textOf(archive, found.get("zoë/report.html")), "right ".repeat(50));
});

test("a file that is not a ZIP archive is refused", () => {
  for (const text of ["", "AAAA", btoa("x".repeat(100))]) assert.throws(() => entries(bytes(text)), /no ZIP archive/);
});

test("no more than the limit is unpacked, whatever size the archive states", async () => {
  const archive = bytes(ARCHIVE);
  const deflated = entries(archive).get("zoë/report.html");
  assert.equal(await bytesOf(archive, deflated, 299), null);
  assert.equal((await bytesOf(archive, deflated, 300)).length, 300);
  assert.equal(await bytesOf(archive, entries(archive).get("index.html"), 8), null);
});

test("an archive may end with a comment, and damage is noticed", () => {
  const plain = new Uint8Array(bytes(ARCHIVE));
  const commented = new Uint8Array([...plain, 0x68, 0x69]);
  commented[plain.length - 2] = 2;
  assert.equal(entries(commented.buffer).size, 2);
  const head = plain.findIndex((_, i) => [0x50, 0x4b, 1, 2].every((byte, j) => plain[i + j] === byte));
  for (const [at, value] of [[head, 0], [head + 23, 0xff], [head + 45, 0xff]]) {
    const damaged = plain.slice();
    damaged[at] = value;
    assert.throws(() => entries(damaged.buffer));
  }
});

test("some entries of an archive are an archive", async () => {
  const archive = bytes(ARCHIVE);
  const part = await archiveOf(archive, [entries(archive).get("zoë/report.html")]).arrayBuffer();
  const found = entries(part);
  assert.deepEqual([...found.keys()], ["zoë/report.html"]);
  assert.equal(await textOf(part, found.get("zoë/report.html")), "right ".repeat(50));
});
