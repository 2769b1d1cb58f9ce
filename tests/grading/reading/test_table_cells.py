"""Test how the cells of a table are read."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import AngleUnit
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading import table_cells as reading_cells
from dh_grader.grading.reading.entries import Entry, Reader
from dh_grader.grading.reading.pasted_table import MAX_CHARACTERS, MAX_MARKS, read_marks
from dh_grader.grading.reading.table import StudentTable, read_table
from dh_grader.grading.reading.table_cells import canonical_table, memoized_row, read_row
from dh_grader.grading.report import Finding, UnreadableAnswerError, Verdict, WorkBudget

from tests.grading.support.submitting import full_marks, handed_in, part, table

# --- Read the cells of a table

# Craig, Introduction to Robotics, the planar two-link arm in the standard convention.
ROWS: list[list[Any]] = [["l1", "0", "0", "q1"], ["l2", 0, "0", "q2"]]
TABLE = table(ROWS)


def named(keys: str, rows: list[list[Any]]) -> list[dict[str, Any]]:
    return [dict(zip(keys.split("|"), row, strict=True)) for row in rows]


@pytest.mark.parametrize(
    "answer",
    [
        TABLE,
        TABLE["rows"],
        ROWS,
        {"rows": ROWS},
        [("a", "alpha", "d", "theta"), *ROWS][1:],
        [["a", "alpha", "d", "theta"], *ROWS],
        [["i", "a_i", "α_i", "d_i", "θ_i"], *([i + 1, *row] for i, row in enumerate(ROWS))],
        [["theta", "d", "a", "alpha"], *([r[3], r[2], r[0], r[1]] for r in ROWS)],
        [["1", *ROWS[0]], ["2", *ROWS[1]]],
        [[2, *ROWS[1]], [1, *ROWS[0]]],
        named("a|α|d|θ", ROWS),
        named("A|Alpha|D|Theta", ROWS),
        named("a_i|alpha_i|d_i|theta_i", ROWS),
        named("a_{i-1}|α_{i-1}|d_i|θ_i", ROWS),
        named("link length|twist|offset|joint angle", ROWS),
        named("link_length|link_twist|link_offset|joint_angle", ROWS),
        named("r|alpha|d|theta", ROWS),
        named(r"$a_i$|$\alpha_i$|$d_i$|$\theta_i$", ROWS),
        {"rows": named("a|α|d|θ", ROWS)},
        [{"joint": 2, "type": "R", **TABLE["rows"][1]}, {"joint": 1, **TABLE["rows"][0]}],
        [{"note": "base", **TABLE["rows"][0]}, {"why": "?", **TABLE["rows"][1]}],
    ],
)
def test_a_table_in_each_shape_is_converted(answer: object) -> None:
    assert canonical_table(answer) == TABLE


def test_fields_besides_the_rows_are_kept() -> None:
    answer = {"rows": ROWS, "convention": "modified"}
    assert canonical_table(answer) == {**TABLE, "convention": "modified"}


def test_the_canonical_answer_is_not_copied() -> None:
    assert canonical_table(TABLE) is TABLE


@pytest.mark.parametrize(
    "answer",
    [
        None, 1, True, "a,alpha,d,theta\n0,0,0,q1", {}, [], ["0", "0", "0", "q1"], [[]], [{}],
        {"rows": "0,0,0,q1"}, {"rows": 3}, {"rows": []}, {"table": ROWS}, ["0,0,0,q1"], [None],
        [["1", *"0000"]] * 2, [["l1", *"0000"]],
        [[["1", "0", "0", "0"]] * 4] * 2, [{"x": 1, "y": 2}], [["1", "2", "3"]], [["0"] * 5],
        {"a": "l1", "alpha": 0, "d": 0, "theta": "q1"},
    ],
)  # fmt: skip
def test_an_answer_that_is_not_a_table_is_unchanged(answer: object) -> None:
    assert canonical_table(answer) == answer


@pytest.mark.parametrize(
    "row",
    [
        ["l2", "0", "0"],
        ["l2", "0", "0", "q2", "0"],
        [["l2"], "0", "0", "q2"],
        None,
        "l2, 0, 0, q2",
        # Two keys for one column; and a unit, which a canonical cell cannot have.
        {"a": "l2", "α": 0, "alpha": "pi", "d": 0, "theta": "q2"},
        {"a": "l2", "alpha (deg)": 90, "d": 0, "theta": "q2"},
        {"a [mm]": 300, "alpha": 0, "d": 0, "theta": "q2"},
    ],
)
def test_an_ambiguous_row_affects_only_itself(row: object) -> None:
    assert canonical_table([ROWS[0], row]) == {"rows": [TABLE["rows"][0], row]}
    assert canonical_table({"rows": [ROWS[0], row]}) == {"rows": [TABLE["rows"][0], row]}


def test_an_omitted_column_stays_omitted() -> None:
    assert canonical_table([{"α": 0, "d": "d1"}]) == {"rows": [{"alpha": 0, "d": "d1"}]}


def test_the_tool_row_comes_last() -> None:
    tool = {"i": "e", "a": "l3", "alpha": 0, "d": 0, "theta": 0}
    first = {"i": "1", **TABLE["rows"][0]}
    expected = {"rows": [TABLE["rows"][0], {"a": "l3", "alpha": 0, "d": 0, "theta": 0}]}
    assert canonical_table([tool, first]) == expected


@pytest.mark.parametrize("labels", [(1, 1), (2, "x"), ("", 1), (2, None)])
def test_labels_without_an_order_leave_the_rows_unchanged(labels: tuple[object, object]) -> None:
    rows = [{"i": label, **row} for label, row in zip(labels, TABLE["rows"], strict=True)]
    assert canonical_table(rows) == TABLE


def test_a_single_row_of_names_is_a_row() -> None:
    # If a and d are declared lengths, the only row of a table may look like headers.
    assert canonical_table([["a", "alpha", "d", "theta"]]) == table([["a", "alpha", "d", "theta"]])


def test_too_many_rows_are_still_counted() -> None:
    found = canonical_table([ROWS[0]] * 500)
    assert isinstance(found, dict)
    assert len(found["rows"]) == 500


def test_only_the_first_names_of_a_body_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    # Each name costs about ten microseconds, and a request may have tens of thousands of names.
    read: list[str] = []
    monkeypatch.setattr(reading_cells, "read_header", read.append)
    canonical_table([{f"α_{i}_{j}": 0 for j in range(200)} for i in range(50)])
    assert 4 < len(read) < 100


def test_a_number_of_any_length_raises_nothing() -> None:
    # Python raises an error if an integer of more than 4,300 digits is converted to text.
    rows = [{"i": 10**5000, "a": 0, "alpha": 0, "d": 0, "theta": "q1"}]
    assert canonical_table(rows) == {"rows": [{"a": 0, "alpha": 0, "d": 0, "theta": "q1"}]}


# Memoized rows have the same entries and the same cost as rows that are read.

ROW = ("0", " -90", "d2 + 1", "theta2")


@pytest.fixture
def exercise(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["stanford-arm"]


def reader_of(exercise: Exercise, unit: AngleUnit = "radians", symbols: int = 100) -> Reader:
    samples = draw(exercise, {})
    budget = WorkBudget(symbols=symbols)
    return Reader(exercise.vocabulary, samples, unit, "m", budget)


def told(entry: Entry) -> tuple[str, tuple[Finding, ...]]:
    assert entry.expression is not None
    return entry.expression.text(), entry.findings


@pytest.mark.parametrize("unit", ["radians", "degrees"])
def test_a_memoized_row_is_the_one_that_is_read(exercise: Exercise, unit: AngleUnit) -> None:
    fresh, remembering = reader_of(exercise, unit), reader_of(exercise, unit)
    expected = read_row(ROW, 2, fresh)
    for _ in range(2):
        remembering.budget.symbols = 100
        found = memoized_row(ROW, remembering)
        assert found is not None
        assert list(map(told, found)) == list(map(told, expected))
        assert remembering.budget == fresh.budget


def test_the_memo_distinguishes_units(exercise: Exercise) -> None:
    inner = memoized_row(("0", "90", "0", "0"), reader_of(exercise))
    degrees = memoized_row(("0", "90", "0", "0"), reader_of(exercise, "degrees"))
    assert inner is not None
    assert degrees is not None
    assert told(inner[1]) != told(degrees[1])


@pytest.mark.parametrize(
    "cells",
    [
        ("0", "-90deg", "(d2", "theta2"),
        ("0", "-90deg", "", "theta2"),
        ("0", "-90deg", None, "theta2"),
        (0, "-90deg", "d2", "theta2"),
        ("0", "-90deg", "theta9", "theta2"),
        ("0", "-90deg", " " * 90 + "d2", "theta2"),
        ("0", "-90deg", "d2", "theta_1 = theta2"),  # right in one row, wrong in another
    ],
)
def test_long_named_or_unreadable_rows_are_not_memoized(
    exercise: Exercise, cells: tuple[object, ...]
) -> None:
    reader = reader_of(exercise)
    for _ in range(2):
        assert memoized_row(cells, reader) is None
        assert reader.budget == WorkBudget(symbols=100)


def test_the_memo_has_no_row_beyond_the_budget(exercise: Exercise) -> None:
    assert memoized_row(ROW, reader_of(exercise)) is not None
    short = reader_of(exercise, symbols=3)
    assert memoized_row(ROW, short) is None
    assert short.budget.symbols == 3


# --- Marked cells

LABELS = ("4", "5", "6", "e")


@pytest.mark.parametrize(
    ("answer", "cells"),
    [
        ("5.alpha", {(1, 1)}),
        ("5 θ", {(1, 3)}),
        ("E.d", {(3, 2)}),
        ("6/a; 4:d\n", {(2, 0), (0, 2)}),
        (["row 4", "5.a"], {(0, 0), (0, 1), (0, 2), (0, 3), (1, 0)}),
        (6, {(2, 0), (2, 1), (2, 2), (2, 3)}),
    ],
)
def test_places_are_read_by_label_and_column(answer: object, cells: set[tuple[int, int]]) -> None:
    read = read_marks(answer, LABELS)
    assert read.cells == cells
    assert read.verdict is None


@pytest.mark.parametrize("answer", [None, "", [], " , ", [""]])
def test_nothing_is_marked(answer: object) -> None:
    assert read_marks(answer, LABELS).verdict is Verdict.MISSING


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ("1.alpha", "unknown_place"),
        ("5.beta", "unknown_place"),
        ("alpha", "unknown_place"),
        (["5.a", "here"], "unknown_place"),
        (-5, "wrong_shape"),
        (True, "wrong_shape"),
        (5.0, "wrong_shape"),
        ({"row": 5}, "wrong_shape"),
        ([["5.a"]], "wrong_shape"),
        (["5.a"] * (MAX_MARKS + 1), "wrong_shape"),
        ("5.a," * MAX_CHARACTERS, "wrong_shape"),
    ],
)
def test_one_unreadable_mark_makes_all_unreadable(answer: object, code: str) -> None:
    read = read_marks(answer, LABELS)
    assert read.verdict is Verdict.UNREADABLE
    assert [finding.code for finding in read.findings] == [code]
    assert not read.cells


# --- Convert or refuse the units in the headers of a pasted table

ARM = """
title = "An arm"
source = "test"
statement = "test"

[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["0.25", "90deg", "l1", "q1"], ["l2", "0", "0", "q2 - 90deg"]]

[symbols]
l1 = { kind = "length", unit = "UNIT", range = [0.3, 0.9], description = "l1" }
l2 = { kind = "length", unit = "UNIT", range = [0.3, 0.9], description = "l2" }

[[parts]]
id = "table"
kind = "dh_table"
title = "table"
convention = "standard"
"""

Maker = Callable[[str], Exercise]


@pytest.fixture
def arm(make_exercise: Maker) -> Exercise:
    return make_exercise(ARM.replace("UNIT", "m"))


def read(exercise: Exercise, text: str, angle_unit: AngleUnit = "radians") -> StudentTable:
    return read_table(text, Reader.of(exercise, draw(exercise, text), angle_unit))


def table_in_units(head: str, cell: str) -> str:
    return f"{head}, alpha, d, theta\n{cell}, 90deg, l1, q1\nl2, 0, 0, q2 - 90deg"


def length_unit(exercise: Exercise) -> str | None:
    return Reader.of(exercise, draw(exercise, ""), "radians").length_unit


def test_a_reader_has_the_length_unit_of_its_exercise(make_exercise: Maker, arm: Exercise) -> None:
    assert length_unit(arm) == "m"
    assert length_unit(make_exercise(ARM.replace("UNIT", "mm"))) == "mm"
    assert length_unit(make_exercise(ARM.replace("UNIT", "m", 1).replace("UNIT", "mm"))) is None


@pytest.mark.parametrize(
    ("statement", "unit"),
    [
        ("All lengths are in metres.", "metres"),
        ("Alle Längen in Millimetern.", "millimetern"),
        ("Lengths are in millimeters, and angles in degrees.", "millimeters"),
        ("Lengths in metres, offsets in mm or in inches.", None),
        ("Joint 1 turns in front of joint 2.", None),
    ],
)
def test_without_lengths_as_letters_the_statement_names_the_unit(
    statement: str, unit: str | None, make_exercise: Maker
) -> None:
    numbers = ARM.partition("[symbols]")[0] + "[[parts]]" + ARM.partition("[[parts]]")[2]
    numbers = numbers.replace("l1", "0.4").replace("l2", "0.3")
    exercise = make_exercise(numbers.replace('statement = "test"', f'statement = "{statement}"'))
    assert length_unit(exercise) == unit
    lettered = make_exercise(ARM.replace('statement = "test"', f'statement = "{statement}"'))
    assert length_unit(lettered) == "UNIT"


@pytest.mark.parametrize(
    ("head", "cell", "metres"),
    [
        ("a", "0.25", 0.25),
        ("a (m)", "0.25", 0.25),
        ("a [mm]", "250", 0.25),
        ("a [mm]", "2.5e2", 0.25),
        ("a [mm]", "-(200 + 50)", -0.25),
        ("a in cm", "25", 0.25),
        ("a (in)", "10", 0.254),
        ("a [mm]", "0", 0.0),
    ],
)
def test_a_number_is_converted(head: str, cell: str, metres: float, arm: Exercise) -> None:
    [first, _] = read(arm, table_in_units(head, cell)).rows
    assert first.values[0] == pytest.approx(metres, rel=1e-12)


def test_a_sentence_with_another_unit_than_a_header_is_refused(arm: Exercise) -> None:
    note = "\n\nNote: all lengths in m"
    assert read(arm, table_in_units("a (m)", "0.25") + note).rows[0].values[0] == pytest.approx(
        0.25
    )
    with pytest.raises(UnreadableAnswerError) as caught:
        read(arm, table_in_units("a [mm]", "250") + note)
    assert caught.value.finding.code == "text_around"


@pytest.mark.parametrize("head", ["a [mm]", "a (m)"])
@pytest.mark.parametrize("cell", ["l1", "2*l1 - l2/3", "l1*cos(q1)", "sqrt(l1^2 + l2^2)", "-l2"])
def test_letters_are_not_converted(head: str, cell: str, arm: Exercise) -> None:
    [first, _] = read(arm, table_in_units(head, cell)).rows
    [plain, _] = read(arm, table_in_units("a", cell)).rows
    assert first.entries[0].readable
    assert first.entries[0].expression is plain.entries[0].expression


@pytest.mark.parametrize("cell", ["l1 + 100", "100 - l1", "l1*l2", "100*cos(q1)", "l1/l2"])
def test_a_number_among_letters_is_refused(cell: str, arm: Exercise) -> None:
    text = table_in_units("a [mm]", cell)
    [first, second] = read(arm, text).rows
    assert first.entries[0].verdict is Verdict.UNREADABLE
    [finding] = first.entries[0].findings
    assert finding.code == "header_unit"
    assert finding.span is not None
    assert text[slice(*finding.span)] == cell
    assert second.entries[0].readable
    assert read(arm, table_in_units("a (m)", cell)).rows[0].entries[0].readable


def test_a_conversion_gets_a_note(arm: Exercise) -> None:
    [first, second] = read(arm, table_in_units("a [mm]", "250")).rows
    [finding] = first.entries[0].findings
    assert (finding.code, finding.hint) == (
        "converted_length", "Read as 250 mm, as the header says.",
    )  # fmt: skip
    assert second.entries[0].findings == ()


def test_an_exercise_with_several_units_converts_nothing(make_exercise: Maker) -> None:
    exercise = make_exercise(ARM.replace("UNIT", "m", 1).replace("UNIT", "mm"))
    [first, second] = read(exercise, table_in_units("a [mm]", "250")).rows
    assert first.entries[0].verdict is Verdict.UNREADABLE
    assert second.entries[0].readable


def test_the_exercise_may_have_millimetres(make_exercise: Maker) -> None:
    exercise = make_exercise(ARM.replace("UNIT", "mm"))
    assert read(exercise, table_in_units("a (mm)", "250")).rows[0].values[0] == pytest.approx(250)
    assert read(exercise, table_in_units("a (m)", "0.25")).rows[0].values[0] == pytest.approx(250)


@pytest.mark.parametrize("angle_unit", ["radians", "degrees"])
@pytest.mark.parametrize(
    ("alpha", "theta", "twist", "angle"),
    [
        ("alpha (deg)", "theta (deg)", "90", "q2 - 90"),
        ("alpha (rad)", "theta (rad)", "pi/2", "q2 - 1.5707963267948966"),
        ("alpha (deg)", "theta (rad)", "90", "q2 - 1.5707963267948966"),
        ("alpha (rad)", "theta [°]", "1.5707963267948966", "q2 - 90"),
        ("alpha (rad)", "theta (rad)", "90°", "q2 - 90deg"),
    ],
)
def test_a_header_overrides_the_submission(
    alpha: str, theta: str, twist: str, angle: str, angle_unit: AngleUnit, arm: Exercise
) -> None:
    text = f"a, {alpha}, d, {theta}\n0.25, {twist}, l1, q1\nl2, 0, 0, {angle}"
    report = handed_in(arm, {"table": text}, angle_unit)
    assert full_marks(part(report, "table")), report


def test_without_a_unit_the_submission_decides(arm: Exercise) -> None:
    text = "a, alpha, d, theta\n0.25, 90, l1, q1\nl2, 0, 0, q2 - 90"
    assert full_marks(part(handed_in(arm, {"table": text}, "degrees"), "table"))
    assert not full_marks(part(handed_in(arm, {"table": text}, "radians"), "table"))


def test_a_name_may_be_a_header_or_a_declared_length(make_exercise: Maker) -> None:
    # The row a, alpha, d, q is a header even if all four are symbols; a, 0, d, q is not.
    text = ARM.replace("UNIT", "m").replace("l1", "a").replace("l2", "d")
    exercise = make_exercise(text)
    plain = "0.25, 90deg, a, q1\nd, 0, 0, q2 - 90deg"
    for pasted in (plain, f"a, alpha, d, q\n{plain}"):
        assert full_marks(part(handed_in(exercise, {"table": pasted}), "table"))
    [first, _] = read(exercise, "a, 0, d, q1\nd, 0, 0, q2").rows
    assert all(entry.readable for entry in first.entries)
    with pytest.raises(UnreadableAnswerError) as caught:
        read(exercise, "a, d, foo, bar\n0, 0, 0, 0")
    assert caught.value.finding.code == "unknown_header"


def test_a_joint_variable_that_the_robot_lacks_is_wrong_below_a_unit(
    catalogue: Mapping[str, Exercise],
) -> None:
    text = "a [mm], alpha, d [mm], theta\n300, 0, d1, q1"
    report = part(handed_in(catalogue["rrrp"], {"table": text}), "table")
    assert report.rows[0].cells[2].verdict is Verdict.INCORRECT


@pytest.mark.parametrize(
    ("head", "suggestion"), [("a [mm]", "250"), ("a", "0.25"), ("a [m]", "0.25")]
)
def test_the_repair_of_a_length_with_a_unit_is_in_the_unit_of_its_header(
    head: str, suggestion: str, arm: Exercise
) -> None:
    [finding] = read(arm, table_in_units(head, "0.25 m")).rows[0].entries[0].findings
    assert finding.suggestion == suggestion
