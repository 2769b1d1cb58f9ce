"""Every submission, even a hostile one, soon gets a report."""

import json
import time
from collections.abc import Callable, Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import LIMITS
from dh_grader.grading import FeedbackLevel, Report, Submission, UnknownPartError, Verdict, grade
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.robots import EXACT, STANFORD
from tests.grading.support.submitting import (
    as_data,
    cell,
    codes_at,
    handed_in,
    not_correct,
    part,
    table,
)
from tests.grading.support.worth import about, points
from tests.guards import STALL
from tests.together import together


def nested(levels: int, core: Any = 0) -> Any:
    for _ in range(levels):
        core = [core]
    return core


UNREADABLE: dict[str, Any] = {
    "import": '__import__("os")',
    "attribute": "q1.__class__.__mro__",
    "lambda": "(lambda: 0)()",
    "subscript": "[].__len__",
    "tower": "9**9**9**9",
    "tower of powers": "9^9^9^9",
    "shift": "1<<3*10**9",
    "string": "'a'*10**9",
    "10,000 parentheses": "(" * 10_000,
    "10,000 balanced parentheses": "(" * 10_000 + "0" + ")" * 10_000,
    "250 parentheses": "(" * 249 + "0" + ")" * 249,
    "500 minus signs": "-" * 499 + "1",
    "250 functions": "sin " * 124 + "1",
    "a million characters": "1+" * 500_000 + "1",
    "too many nodes": "1+" * 249 + "1",
    "lone surrogate": "\ud800",
    "lone low surrogate": "q1\udfff",
    "null": "\x00",
    "right to left": "\u202e1",
    "combining": "q1" + "\u0301" * 400,
    "NaN": float("nan"),
    "inf": float("inf"),
    "-inf": float("-inf"),
    "NaN as text": "nan",
    "10^400": 10**400,
    "5000 digits": 10**5000,
    "1e400 as text": "1e400",
    "true": True,
    "false": False,
    "list": ["q1"],
    "empty list": [],
    "dict": {"a": 1},
    "empty dict": {},
    "deep list": nested(200),
    "very deep list": nested(5000),
    "HTML": "<script>alert(1)</script>",
    "percent": "%s%n",
    "comment": "q1 # 0",
    "backslash": "\\",
    "unclosed LaTeX": r"\frac{\frac{\frac{1}",
    "deep LaTeX": r"\frac{" * 80,
}
EMPTY: dict[str, Any] = {"empty": "", "blank": " \t\n", "none": None, "no-break space": "\u00a0"}
# Readable wrong values, up to the limits of floating point.
EXTREME: dict[str, Any] = {
    "1e308": "1e308",
    "1e308 as a number": 1e308,
    "10^308": 10**308,
    "-1e308": "-1e308",
    "overflow": "1e308*10",
    "tower of brackets": "((9^9)^9)^9",
    "exponential": "exp(exp(exp(9)))",
    "subnormal": "q1 + 5e-324*1e308",
    "1/0": "1/0",
    "0/0": "0/0",
    "infinity minus infinity": "1/0 - 1/0",
    "root": "sqrt(-1)",
    "pole": "1/(q1 - q1)",
    "sometimes undefined": "sqrt(q1)",
    "huge product": "1e300*q1*q2",
    "nearly overflowing joint": "1e307*q1",
    "huge difference": "1e308*q1 - 1e308*q2",
    "tangent": "tan(q1)^99",
    "longest sum": "1+" * 99 + "1",
    "longest product": "*".join(["q1"] * 99),
    "longest sines": "sin(q1)*sin(q2)*" * 24 + "1",
}


def place_everywhere(value: Any) -> dict[str, object]:
    rows: list[list[Any]] = [list(row) for row in EXACT.rows(STANFORD)]
    for i, row in enumerate(rows):
        row[i % 4] = value
    pose = [["0", "0", "0", "0"] for _ in range(3)] + [["0", "0", "0", value]]
    return {"table": table(rows), "pose": pose}


def timed(work: Callable[[], Report]) -> tuple[Report, float]:
    start = time.process_time()
    report = work()
    return report, time.process_time() - start


def check_cost(spent: float) -> None:
    assert spent < STALL, f"{1000 * spent:.1f} ms"


PLACES = {(str(i + 1), ("a", "alpha", "d", "theta")[i % 4]) for i in range(6)}


@pytest.mark.long
@together("name", UNREADABLE)
def test_an_unreadable_value_affects_only_its_cells(
    name: str, given_frames: Mapping[str, Exercise]
) -> None:
    answers = place_everywhere(UNREADABLE[name])
    report, spent = timed(lambda: handed_in(given_frames[STANFORD.exercise], answers))
    check_cost(spent)
    assert not_correct(part(report, "table")) == dict.fromkeys(PLACES, Verdict.UNREADABLE)
    assert cell(part(report, "pose"), "4", "4").verdict is Verdict.UNREADABLE
    assert cell(part(report, "pose"), "4", "3").verdict is Verdict.CORRECT
    json.dumps(as_data(report), allow_nan=False).encode("ascii")


@pytest.mark.parametrize("name", EMPTY)
def test_an_empty_cell_is_missing(name: str, given_frames: Mapping[str, Exercise]) -> None:
    report = handed_in(given_frames[STANFORD.exercise], place_everywhere(EMPTY[name]))
    assert not_correct(part(report, "table")) == dict.fromkeys(PLACES, Verdict.MISSING)
    assert cell(part(report, "pose"), "4", "4").verdict is Verdict.MISSING


@pytest.mark.parametrize("name", EXTREME)
def test_extreme_values_are_wrong_without_warnings(
    name: str, given_frames: Mapping[str, Exercise]
) -> None:
    # Extreme values raise no warnings, which are errors in tests.
    answers = place_everywhere(EXTREME[name])
    report, spent = timed(lambda: handed_in(given_frames[STANFORD.exercise], answers))
    check_cost(spent)
    lengths = {place for place in PLACES if place[1] in ("a", "d")}
    found = not_correct(part(report, "table"))
    assert lengths <= set(found) <= PLACES
    assert set(found.values()) == {Verdict.INCORRECT}
    assert cell(part(report, "pose"), "4", "3").verdict is Verdict.CORRECT
    json.dumps(as_data(report), allow_nan=False)


NO_TABLE: dict[str, Any] = {
    "number": 5,
    "text": "0 0 0 q1",
    "true": True,
    "list": [],
    "empty object": {},
    "rows of no list": {"rows": 3},
    "rows of text": {"rows": "q1"},
    "rows of nothing": {"rows": None},
    "rows of an object": {"rows": {"a": "0"}},
    "13 rows": {"rows": [{}] * 13},
    "100,000 rows": {"rows": [{}] * 100_000},
    "very deep": {"rows": nested(5000)[0], "convention": "standard"},
}


@together("level", list(FeedbackLevel))
@together("name", [name for name in NO_TABLE if name != "very deep"])
def test_an_answer_without_a_table_is_unreadable(
    name: str, level: FeedbackLevel, given_frames: Mapping[str, Exercise]
) -> None:
    answers = {"table": NO_TABLE[name]}
    report, spent = timed(
        lambda: handed_in(given_frames[STANFORD.exercise], answers, feedback=level)
    )
    check_cost(spent)
    found = part(report, "table")
    assert (found.verdict, found.points, found.rows) == (Verdict.UNREADABLE, 0.0, ())
    [feedback] = found.feedback
    assert feedback.code in ("wrong_shape", "too_many_rows")
    assert report.gradable is False


def test_a_table_of_thousands_of_brackets_raises_no_error(
    given_frames: Mapping[str, Exercise],
) -> None:
    report = handed_in(given_frames[STANFORD.exercise], {"table": NO_TABLE["very deep"]})
    assert part(report, "table").points == 0


@pytest.mark.parametrize(
    "row", ["0", "q1", 5, 0, 0.0, True, ["0", "0", "q1"], [], None, "", nested(50)]
)
def test_a_row_that_is_not_an_object_earns_nothing(
    row: object, given_frames: Mapping[str, Exercise]
) -> None:
    # A single "0" instead of a row is not a row of zeros.
    answer = table(EXACT.rows(STANFORD))
    answer["rows"][2] = row
    found = part(handed_in(given_frames[STANFORD.exercise], {"table": answer}), "table")
    assert [row.points for row in found.rows] == about(points(STANFORD, [2] * 4))
    assert found.rows[2].verdict in (Verdict.UNREADABLE, Verdict.MISSING)


NO_MATRIX: dict[str, Any] = {
    "number": 5,
    "text": "[[1]]",
    "true": True,
    "empty": [],
    "object": {"rows": []},
    "5x5": [["0"] * 5 for _ in range(5)],
    "5x4": [["0"] * 4 for _ in range(5)],
    "100,000 rows": [["0"]] * 100_000,
}


@pytest.mark.parametrize("name", NO_MATRIX)
def test_an_answer_without_a_matrix_is_unreadable(
    name: str, given_frames: Mapping[str, Exercise]
) -> None:
    report, spent = timed(
        lambda: handed_in(given_frames[STANFORD.exercise], {"pose": NO_MATRIX[name]})
    )
    check_cost(spent)
    found = part(report, "pose")
    assert (found.verdict, found.points, found.rows) == (Verdict.UNREADABLE, 0.0, ())
    assert [feedback.code for feedback in found.feedback] == ["wrong_shape"]
    assert not report.gradable


def test_the_costliest_submission_is_graded_soon(
    given_frames: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    # Every cell has a different long wrong expression, so that no expression is memoized.
    exercise = given_frames[STANFORD.exercise]
    letters = ("q1", "q2", "q4", "q5", "q6", "d2", "d3", "d6")

    def text(i: int) -> str:
        calls = [f"sin({letters[(i + k) % 8]}+{i}.{k})" for k in range(50)]
        return "*".join(calls)

    handed_in(exercise, {"pose": [["0"]]})  # values that are computed on first use do not count
    answers = {
        "table": table([[text(4 * i + j) for j in range(4)] for i in range(12)]),
        "pose": [[text(100 + 4 * i + j) for j in range(4)] for i in range(4)],
    }
    assert 600 < len(text(115)) <= LIMITS.characters
    report, spent = timed(lambda: handed_in(exercise, answers))
    first = part(report, "table").rows[0].cells
    assert Verdict.UNREADABLE not in [cell.verdict for cell in first]
    assert codes_at(part(report, "pose"), "4", "4") == ["too_long"]
    figure(f"64 expressions of {len(text(100))} characters: {1000 * spent:.0f} ms of process time")
    # Benchmarks watch this figure; the test fails only if grading hangs.
    assert spent < STALL


def test_an_unknown_part_raises_an_error(given_frames: Mapping[str, Exercise]) -> None:
    with pytest.raises(
        UnknownPartError, match=r"has no part 'tabel'; it has table, pose"
    ) as caught:
        grade(given_frames[STANFORD.exercise], Submission({"tabel": table([])}))
    assert (caught.value.unknown, caught.value.known) == ("tabel", ("table", "pose"))


JSON_VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=12)
    | st.sampled_from(["q1", "d3*", "-90deg", "c12", "1/0", "l1 +", "pi/2", "(" * 30]),
    lambda children: (
        st.lists(children, max_size=5) | st.dictionaries(st.text(max_size=5), children, max_size=4)
    ),
    max_leaves=12,
)
ROWS = st.lists(
    st.dictionaries(st.sampled_from(["a", "alpha", "d", "theta", "x"]), JSON_VALUES) | JSON_VALUES,
    max_size=8,
)
MATRICES = st.lists(st.lists(JSON_VALUES, min_size=3, max_size=5) | JSON_VALUES, max_size=5)


@pytest.mark.long
@given(
    table_answer=st.builds(lambda rows: {"rows": rows}, ROWS) | JSON_VALUES,
    pose_answer=MATRICES | JSON_VALUES,
    degrees=st.booleans(),
    level=st.sampled_from(list(FeedbackLevel)),
)
def test_any_json_gets_a_report(
    given_frames: Mapping[str, Exercise],
    table_answer: object,
    pose_answer: object,
    degrees: bool,
    level: FeedbackLevel,
) -> None:
    answers = {"table": table_answer, "pose": pose_answer}
    unit = "degrees" if degrees else "radians"
    report = grade(
        given_frames[STANFORD.exercise],
        Submission(
            answers, angle_unit="degrees" if unit == "degrees" else "radians", feedback=level
        ),
    )
    assert 0 <= report.points <= report.max_points
    assert report.points == pytest.approx(sum(part.points for part in report.parts))
    json.dumps(as_data(report), allow_nan=False)
