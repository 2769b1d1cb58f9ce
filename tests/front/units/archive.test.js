import assert from "node:assert/strict";
import { test } from "node:test";
import { entries, textOf } from "../../../service/web/static/tutor/zip.js";

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
