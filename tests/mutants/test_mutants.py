"""Test the runner of mutants: which changes it makes, where it puts them, and what kills them."""

import ast
import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tests.mutants.__main__ import Equivalent, Package, equivalents, report, tried
from tests.mutants.mutations import mutants
from tests.mutants.session import Reached, Result, functions_of, put_into
from tests.together import together

ROOT = Path(__file__).parents[2]


def changed(source: str) -> set[str]:
    return {mutant.after for mutant in mutants(ast.parse(source))}


@together(
    ("source", "expected"),
    [
        ("def f(a): return a < 3", {"return a <= 3", "return a < 4", "return a < 2", "return True",
                                    "return False"}),
        ("def f(a, b): return a and b", {"return a or b", "return a", "return b", "return True",
                                         "return False"}),
        ("def f(a):\n if not a: raise E", {"if a:", "if not not a:", "pass"}),
        ("def f(a, b): g(a, b, c=1)", {"g(b, a, c=1)", "g(a, b)", "g(a, b, c=2)", "g(a, b, c=0)",
                                       "pass"}),
        ("def f(a): return [x for x in a if x]", {"return None", "return [x for x in a if not x]",
                                                  "return [x for x in a if True]"}),
        ("X = max(1e-9, 0.5)", {"X = min(1e-09, 0.5)", "X = max(1e-08, 0.5)", "X = max(1e-10, 0.5)",
                                "X = max(1e-09, 1.0)", "X = max(1e-09, 0.25)"}),
        ("@a\ndef f(): pass", {"def f():"}),
        ("def f(a):\n match a:\n  case 1: return\n  case _: pass",
         {"match a: 1", "match a: _", "match a: 2 | _", "match a: 0 | _"}),
        ("s.join_from(a, b, full=True)", {"s.join_from(b, a, full=True)", "s.join_from(a, b)",
                                          "s.join_from(a, b, full=False)", "pass"}),
        ("s.order_by(a, b)", {"s.order_by(b, a)", "pass"}),
        # What changes no answer is left alone.
        ("s.where(a, b)\ns.group_by(a, b)\ns.join_from(a, b)", {"pass"}),
        ("@dataclass(frozen=True)\nclass A:\n 'A text.'\n x: Literal[1] | None", set()),
        ("def f() -> int:\n assert True, 1\n _log.info('%s', 1)", set()),
    ],
)  # fmt: skip
def test_a_file_has_these_mutants(source: str, expected: set[str]) -> None:
    assert changed(source) == expected


def test_the_tree_is_as_before_after_each_mutant() -> None:
    source = (ROOT / "service/dh_grader/courses/assignments.py").read_text(encoding="utf-8")
    tree = ast.parse(source)
    found = [(each, compile(tree, "terms.py", "exec")) for each in mutants(tree)]
    assert len(found) > 100
    assert ast.dump(tree) == ast.dump(ast.parse(source))


SOURCE = """
LIMIT = 3
WORDS = {"limit": LIMIT}
class Counter:
    def is_full(self, count, most=LIMIT):
        return count >= most
    @property
    def limit(self):
        return LIMIT
def outer():
    def inner(count):
        return count > LIMIT
    return inner
"""


@pytest.fixture
def loaded(tmp_path: Path) -> Any:
    file = tmp_path / "mutated_module.py"
    file.write_text(SOURCE, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("mutated_module", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["mutated_module"] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules["mutated_module"]


@together(
    ("after", "expected"),
    [
        ("", (True, 3, False, 3)),
        ("return count > most", (False, 3, False, 3)),
        ("return None", (True, None, False, 3)),
        ("return count >= LIMIT", (True, 3, True, 3)),
        # The constant is also in a table.
        ("LIMIT = 2", (True, 2, True, 2)),
    ],
)
def test_a_change_is_put_into_the_loaded_module(
    loaded: ModuleType, after: str, expected: tuple[object, ...]
) -> None:
    counter, inner = loaded.Counter(), loaded.outer()

    def told() -> tuple[object, ...]:
        return counter.is_full(3), counter.limit, inner(3), loaded.WORDS["limit"]

    functions = functions_of(loaded)
    tree = ast.parse(SOURCE)
    for mutant in mutants(tree):
        if mutant.after == after and mutant.function != "outer":
            put_into(loaded, functions, tree, assignments=mutant.place == "assignment")
            break
    assert told() == expected
    put_into(loaded, functions, ast.parse(SOURCE), assignments=True)
    assert told() == (True, 3, False, 3)


def test_a_mutant_is_tried_by_the_tests_that_reach_its_line() -> None:
    seconds = {"home::slow": 4.0, "home::quick": 1.0, "other::quick": 0.5, "home::failed": None}
    lines = {
        "code.py": {"3": ["home::slow", "other::quick"], "4": ["home::quick", "home::failed"]},
        "constants.py": {},
    }
    reached = Reached({"seconds": seconds, "lines": lines})

    def tests(file: str, line: int | None, most: float = 9.0) -> list[str]:
        return reached.tests(file, line, ["home"], most)

    assert tests("code.py", 3) == ["home::slow", "other::quick"]
    assert tests("code.py", 5) == []
    everything = ["home::quick", "home::slow", "other::quick"]
    assert tests("code.py", None) == everything
    assert tests("code.py", None, most=5.2) == everything[:2]
    # Constants run when they are loaded, so that no test reaches their lines.
    assert tests("constants.py", None) == everything


def result(before: str, after: str, end: str) -> Result:
    return Result("service/dh_grader/x.py", 3, "f", before, after, end)


def test_the_report_counts_and_names_survivors(capsys: pytest.CaptureFixture[str]) -> None:
    results = [result("a < b", f"a < {i}", "killed") for i in range(8)]
    results += [result("a < b", "a <= b", "survived"), result("c", "d", "time-out")]
    assert report("x", results, [])
    told = capsys.readouterr().out
    assert "x: 90.0% of 10 killed (8 killed, 1 survived, 1 time-out)" in told
    assert "service/dh_grader/x.py:3: a < b -> a <= b" in told
    results.append(result("e", "f", "unreached"))
    assert not report("x", results, [])
    assert "e -> f (no test reaches it)" in capsys.readouterr().out
    # An equivalent mutant does not count; one that a test kills is no longer equivalent.
    same = [Equivalent("service/dh_grader/x.py", "f", "e", "It is only faster.", "f")]
    assert report("x", results, same)
    assert "of 10 killed" in capsys.readouterr().out
    report(
        "x", results, [Equivalent("service/dh_grader/x.py", "f", "c", "It is only faster.", "d")]
    )
    assert "no longer equivalent: service/dh_grader/x.py:3: c -> d" in capsys.readouterr().out


def test_each_equivalent_mutant_is_one_of_the_code() -> None:
    listed = equivalents()
    for file in {each.file for each in listed}:
        tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
        found = [Result(file, m.line, m.function, m.before, m.after, "") for m in mutants(tree)]
        stale = [
            each
            for each in listed
            if each.file == file and not any(each.fits(one) for one in found)
        ]
        assert stale == []


@pytest.mark.long
def test_the_runner_kills_a_mutant_and_lets_an_equivalent_one_live() -> None:
    file, home = "service/dh_grader/grading/marks.py", "tests/grading/test_points.py"
    package = Package([file], [home], [home])
    results = tried(package, functions=["_unit"])
    ends = {each.after: each for each in results}
    killed = ends["most = max(least, (total - groups) * cells)"]
    assert (killed.end, killed.function, killed.before) == (
        "killed", "_unit", "most = max(least, (total - groups) // cells)"
    )  # fmt: skip
    assert killed.by.startswith(f"{home}::test_")
    # Where this limit counts, the other limit, ``least``, is the larger one.
    equal = "exact = total / (cells + groups * min(BESIDES, MOST_BESIDES * cells * groups))"
    assert ends[equal].end == "survived"
    assert {each.end for each in results} == {"killed", "survived"}


@pytest.mark.long
def test_the_runner_changes_files_that_load_a_plugin_of_pytest() -> None:
    home = "tests/api/test_permissions.py"
    package = Package(["service/dh_grader/api/permissions.py"], [home], [home])
    results = tried(package, functions=["is_loopback"])
    assert {each.end for each in results} == {"killed"}
