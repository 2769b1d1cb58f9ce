import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { answersIn, fragment, packed, Store, unpacked } from "../../../service/dh_grader/web/static/shared/storage.js";

const ANSWERS = { unit: "degrees", parts: { table: { cells: ["a1", "θ₁ + π/2"], choice: "standard" } } };

/** A browser's storage that keeps `room` characters. */
function keep(room = Infinity) {
  const kept = new Map();
  const storage = {
    getItem: (name) => kept.get(name) ?? null,
    removeItem: (name) => kept.delete(name),
    setItem(name, value) {
      if (value.length > room) throw new DOMException("full", "QuotaExceededError");
      kept.set(name, value);
    },
  };
  Object.defineProperty(globalThis, "localStorage", { value: storage, configurable: true });
  return kept;
}

beforeEach(() => keep());

test("a value is packed as URL-safe base64 of UTF-8", () => {
  // printf '{"a":"θ?>"}' | base64 | tr '+/' '-_' | tr -d =
  assert.equal(packed({ a: "θ?>" }), "eyJhIjoizrg_PiJ9");
  assert.deepEqual(unpacked("eyJhIjoizrg_PiJ9"), { a: "θ?>" });
});

test("any other text is unpacked as null", () => {
  for (const text of ["", "%%%", "eyJhIjoi", "_w", "a".repeat(60_001)]) assert.equal(unpacked(text), null);
});

test("answers go into a link and come back", () => {
  assert.deepEqual(answersIn(fragment(ANSWERS)), ANSWERS);
  assert.equal(answersIn("#robot=eyJhIjoxfQ"), null);
  assert.equal(answersIn(""), null);
});

test("a value of another shape is ignored", () => {
  const wrong = [null, 1, [], {}, { parts: null }, { parts: { a: null } }, { parts: { a: { cells: "x" } } }, {
    parts: { a: { cells: [1] } },
  }, { parts: { a: { cells: ["x"] }, b: {} } }];
  for (const value of wrong) assert.equal(answersIn(`#answers=${packed(value)}`), null, JSON.stringify(value));
});

test("missing fields of answers have defaults, and unknown ones are dropped", () => {
  const answers = answersIn(
    `#answers=${packed({ unit: "gradians", parts: { a: { cells: [], choice: 1, more: 2 } } })}`,
  );
  assert.deepEqual(answers, { unit: "radians", parts: { a: { cells: [], choice: "" } } });
});

test("a part may be named like a property of every object", () => {
  const text = '{"unit":"radians","parts":{"__proto__":{"cells":["1"]}}}';
  const answers = answersIn(`#answers=${btoa(text).replaceAll("=", "")}`);
  assert.deepEqual(Object.keys(answers.parts), ["__proto__"]);
});

test("answers are saved for each service and exercise", () => {
  const kept = keep();
  const store = new Store("https://a.example/", "scara");
  assert.equal(store.save(ANSWERS), true);
  assert.deepEqual(store.load(), ANSWERS);
  assert.equal(new Store("https://b.example/", "scara").load(), null);
  assert.equal(store.save(null), true);
  assert.equal(kept.size, 0);
});

test("a browser without storage is not an error", () => {
  keep(10);
  const store = new Store("https://a.example/", "scara");
  assert.equal(store.save(ANSWERS), false);
  assert.equal(store.load(), null);
});

test("a value that another program stored is ignored", () => {
  keep().set("dh-grader:https://a.example/:scara", "{");
  assert.equal(new Store("https://a.example/", "scara").load(), null);
});

test("a tab does not overwrite what another tab has saved, and sets its own answers aside", () => {
  keep();
  const [one, other] = ["a1", "a2"].map((text) => ({
    unit: "radians",
    parts: { table: { cells: [text], choice: "" } },
  }));
  const [first, second] = [new Store("https://a.example/", "scara"), new Store("https://a.example/", "scara")];
  for (const store of [first, second]) store.load();
  assert.equal(first.save(one), true);
  assert.equal(second.isChanged, true);
  assert.equal(second.save(other), false);
  assert.deepEqual(first.load(), one);
  assert.deepEqual(first.aside, other);
  second.keepMine();
  assert.equal(second.save(other), true);
  assert.deepEqual(first.load(), other);
  assert.deepEqual(first.aside, one);
});

test("elements with other parts of an exercise keep each other's answers", () => {
  keep();
  const [table, pose] = ["table", "pose"].map((id) => {
    const store = new Store("https://a.example/", "scara");
    store.parts = [id];
    store.load();
    assert.equal(store.save({ unit: "radians", parts: { [id]: { cells: [id], choice: "" } } }), true);
    return store;
  });
  assert.equal(table.isChanged || pose.isChanged, false);
  assert.deepEqual(Object.keys(table.load()?.parts ?? {}), ["table", "pose"]);
  assert.equal(table.save(null), true);
  assert.deepEqual(Object.keys(pose.load()?.parts ?? {}), ["pose"]);
});
