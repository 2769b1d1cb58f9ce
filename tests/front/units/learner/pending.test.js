import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { PendingHandIn } from "../../../../service/dh_grader/web/static/student/handin/pending.js";

const pending = (key) => ({ key, body: { exercise: "scara", answers: { table: key } } });

/** Give the page a storage that two tabs share; unless `works`, each use of the storage throws an error. */
function storage(works = true) {
  const kept = new Map();
  const checked = (use) => (...words) => {
    if (!works) throw new Error("The browser refuses storage.");
    return use(...words);
  };
  const value = {
    getItem: checked((name) => kept.get(name) ?? null),
    setItem: checked((name, text) => kept.set(name, text)),
    removeItem: checked((name) => kept.delete(name)),
  };
  Object.defineProperty(globalThis, "localStorage", { value, configurable: true });
  return kept;
}

beforeEach(() => storage());

test("a hand-in waits across a reload until it is confirmed", () => {
  new PendingHandIn("scara").set(pending("a"));
  assert.deepEqual(new PendingHandIn("scara").get(), pending("a"));
  assert.equal(new PendingHandIn("planar-rr").get(), null);
  new PendingHandIn("scara").clear("a");
  assert.equal(new PendingHandIn("scara").get(), null);
});

test("a confirmed hand-in leaves that of another tab alone", () => {
  const [one, other] = [new PendingHandIn("scara"), new PendingHandIn("scara")];
  one.set(pending("a"));
  other.set(pending("b"));
  one.clear("a");
  assert.deepEqual(new PendingHandIn("scara").get(), pending("b"));
  other.clear("b");
  // A confirmed hand-in is never pending again, in any tab.
  assert.deepEqual([one.get(), other.get(), new PendingHandIn("scara").get()], [null, null, null]);
});

test("a refused hand-in of one tab does not forget a later one of the same tab", () => {
  const tab = new PendingHandIn("scara");
  tab.set(pending("a"));
  tab.set(pending("b"));
  tab.clear("a");
  assert.deepEqual(tab.get(), pending("b"));
});

test("without storage, a hand-in waits in the page", () => {
  storage(false);
  const tab = new PendingHandIn("scara");
  tab.set(pending("a"));
  tab.clear("other");
  assert.deepEqual(tab.get(), pending("a"));
  tab.clear("a");
  assert.equal(tab.get(), null);
});

test("a damaged entry is no hand-in", () => {
  for (const text of ["", "{", "null", "[]", '{"key": 1}', '{"key": "a", "body": {}}']) {
    storage().set("scara:hand-in", text);
    assert.equal(new PendingHandIn("scara").get(), null);
  }
});
