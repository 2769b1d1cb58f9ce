"""Test hostile answers, and the limit of work."""

import json
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import LIMITS
from dh_grader.grading import (
    FeedbackLevel,
    PartReport,
    Report,
    Submission,
    UnknownPartError,
    Verdict,
    grade,
)
from dh_grader.grading.reading import preview_pasted
from dh_grader.grading.report import WorkBudget, messages_of
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.robots import EXACT, RRRP, STANFORD
from tests.grading.support.submitting import (
    about,
    as_data,
    cell,
    codes_at,
    handed_in,
    not_correct,
    part,
    points,
    table,
)
from tests.guards import STALL
from tests.pasting.writers import FORMATS
from tests.solutions.solved import solved
from tests.together import together

# --- Every submission, even a hostile one, soon gets a report


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


# --- Every pasted text gets a report

HEADERS = ["a [mm]", "alpha (deg)", "d", "theta"]
SEEDS = [write([HEADERS, *EXACT.rows(RRRP)]) for write in FORMATS.values()]
FRAGMENTS = [
    "[", "]", "(", ")", "<td>", "&", "\\\\", "|", '"', "'", ";", ",", "\n", "\t", " ", "=", "$",
    "\ud800", "\u202e", "100", "l1", "a", "theta", "1/0", "1e400", "(mm)", "[deg]", "e", "i",
]  # fmt: skip


@st.composite
def pastes(draw: st.DrawFn) -> str:
    text = draw(st.sampled_from(SEEDS))
    for _ in range(draw(st.integers(0, 5))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 10)))
        text = text[:start] + draw(st.sampled_from(FRAGMENTS)) + text[end:]
    return text


@pytest.mark.long
@given(text=pastes() | st.text(max_size=80), level=st.sampled_from(list(FeedbackLevel)))
def test_any_paste_gets_a_report(
    catalogue: Mapping[str, Exercise], text: str, level: FeedbackLevel
) -> None:
    exercise = catalogue[RRRP.exercise]
    submission = Submission({"table": text, "pose": text}, feedback=level)
    report = grade(exercise, submission)
    assert report == grade(exercise, submission)
    assert 0 <= report.points <= report.max_points
    json.dumps(as_data(report), allow_nan=False)
    messages = [
        message
        for part in report.parts
        for found in (part.feedback, *(c.feedback for row in part.rows for c in row.cells))
        for message in found
        if message.span is not None
    ]
    assert all(0 <= m.span[0] <= m.span[1] <= len(text) for m in messages if m.span)


@pytest.mark.long
@given(text=pastes() | st.text(max_size=80), part=st.sampled_from(["table", "pose"]))
def test_any_paste_has_a_preview(catalogue: Mapping[str, Exercise], text: str, part: str) -> None:
    shown = preview_pasted(text, catalogue[RRRP.exercise], part)
    assert bool(shown.problem) != bool(shown.rows)
    for row in shown.rows:
        for each in row:
            assert 0 <= each.span[0] <= each.span[1] <= len(text)
            assert not (each.problem and each.text)


# --- The search for explanations stops at a limit

# Many kinds of wrong entries: signs, values, variables of other joints, decimals, undefined values.
WRONG = ["-theta1", "d2 + 0.333", "0.707", "sin(theta1)", "1", "theta3", "0^-1", "c1*s2"]
SHIPPED = ["stanford-arm", "scara", "spatial-rrr", "planar-rpr-poe", "simple-twist"]


def spoilt(answer: object, every: int) -> object:
    count = 0

    def changed(inside: object) -> object:
        nonlocal count
        if isinstance(inside, list):
            return [changed(each) for each in inside]
        if isinstance(inside, dict):
            return {
                key: each if key == "convention" else changed(each) for key, each in inside.items()
            }
        count += 1
        return WRONG[count % len(WRONG)] if count % every == 0 else inside

    return changed(answer)


def spoilt_answers(exercise: Exercise) -> Iterator[dict[str, object]]:
    for every in (1, 2, 3, 7):
        yield {part: spoilt(right, every) for part, right in solved(exercise).answers.items()}


def marks(report: Report) -> list[tuple[object, ...]]:
    return [
        (part.part, part.verdict, part.points, row.label, row.verdict, row.points, cell.verdict)
        for part in report.parts
        for row in part.rows
        for cell in row.cells
    ]


def told(report: Report) -> list[str]:
    return [part.part for part in report.parts for m in part.feedback if m.code == "work_limit"]


@pytest.mark.long
@pytest.mark.parametrize("name", SHIPPED)
def test_marks_are_the_same_without_any_explanation(
    name: str, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    exercise = catalogue[name]
    for answers in spoilt_answers(exercise):
        explained = grade(exercise, Submission(answers))
        with monkeypatch.context() as context:
            context.setattr("dh_grader.grading.report.WorkBudget.affords", _affords_nothing)
            bare = grade(exercise, Submission(answers))
        assert marks(bare) == marks(explained), answers
        assert len(told(bare)) <= 1


def _affords_nothing(budget: WorkBudget, work: float) -> bool:
    budget.has_left_out = True
    return False


def everything_wrong(exercise: Exercise) -> dict[str, object]:
    return {part: spoilt(right, 1) for part, right in solved(exercise).answers.items()}


def test_an_omission_gets_one_message(catalogue: Mapping[str, Exercise]) -> None:
    # The 24 wrong cells of the table are explained before the seven wrong matrices.
    exercise = catalogue["stanford-arm"]
    report = grade(exercise, Submission(everything_wrong(exercise)))
    assert len(told(report)) == 1
    assert "value" in _codes(report.parts[0])
    # Messages on unreadable or undefined entries do not need the budget for explanations.
    assert _codes(report.parts[-1]) <= {"undefined", "unknown_joint"}


def _codes(part: PartReport) -> set[str]:
    return {message.code for message, *_ in messages_of(part)}


@pytest.mark.parametrize("level", [FeedbackLevel.VERDICTS, FeedbackLevel.SCORE])
def test_levels_without_hints_have_no_message_on_omissions(
    level: FeedbackLevel, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue["stanford-arm"]
    assert told(grade(exercise, Submission(everything_wrong(exercise), feedback=level))) == []


def test_an_ordinary_wrong_answer_is_explained_completely(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue["stanford-arm"]
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[1][1], rows[3][1], rows[4][3] = "-pi/2", "0", "theta4"
    answers = {**solved(exercise).answers, "table": {"rows": rows}}
    assert told(grade(exercise, Submission(answers))) == []


def test_reading_and_searches_reduce_the_work_for_explanations() -> None:
    read, searched = WorkBudget(), WorkBudget()
    assert read.charge_reading(14_000)
    searched.charge_search(200.0)
    assert searched.affords(70.0)
    assert not searched.affords(20.0)
    assert searched.has_left_out
    assert WorkBudget().affords(140.0)
    assert read.affords(140.0)
    assert read.affords_search(140.0)
    assert not read.affords(1.0)


def test_searches_do_not_depend_on_explanations() -> None:
    bare, explained = WorkBudget(), WorkBudget()
    assert not explained.affords(500.0)
    for budget in (bare, explained):
        assert budget.affords_search(200.0)
        # A refused search costs nothing.
        assert not budget.affords_search(90.0)
        assert budget.affords_search(10.0)
