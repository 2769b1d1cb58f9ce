"""Convert or refuse the units in the headers of a pasted table."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import AngleUnit
from dh_grader.grading import Verdict
from dh_grader.grading.numbers import draw
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.reading.table import StudentTable, read_table
from dh_grader.grading.report import UnreadableAnswerError

from tests.grading.support.submitting import full_marks, handed_in, part

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


def table(head: str, cell: str) -> str:
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
    [first, _] = read(arm, table(head, cell)).rows
    assert first.values[0] == pytest.approx(metres, rel=1e-12)


def test_a_sentence_with_another_unit_than_a_header_is_refused(arm: Exercise) -> None:
    note = "\n\nNote: all lengths in m"
    assert read(arm, table("a (m)", "0.25") + note).rows[0].values[0] == pytest.approx(0.25)
    with pytest.raises(UnreadableAnswerError) as caught:
        read(arm, table("a [mm]", "250") + note)
    assert caught.value.finding.code == "text_around"


@pytest.mark.parametrize("head", ["a [mm]", "a (m)"])
@pytest.mark.parametrize("cell", ["l1", "2*l1 - l2/3", "l1*cos(q1)", "sqrt(l1^2 + l2^2)", "-l2"])
def test_letters_are_not_converted(head: str, cell: str, arm: Exercise) -> None:
    [first, _] = read(arm, table(head, cell)).rows
    [plain, _] = read(arm, table("a", cell)).rows
    assert first.entries[0].readable
    assert first.entries[0].expression is plain.entries[0].expression


@pytest.mark.parametrize("cell", ["l1 + 100", "100 - l1", "l1*l2", "100*cos(q1)", "l1/l2"])
def test_a_number_among_letters_is_refused(cell: str, arm: Exercise) -> None:
    text = table("a [mm]", cell)
    [first, second] = read(arm, text).rows
    assert first.entries[0].verdict is Verdict.UNREADABLE
    [finding] = first.entries[0].findings
    assert finding.code == "header_unit"
    assert finding.span is not None
    assert text[slice(*finding.span)] == cell
    assert second.entries[0].readable
    assert read(arm, table("a (m)", cell)).rows[0].entries[0].readable


def test_a_conversion_gets_a_note(arm: Exercise) -> None:
    [first, second] = read(arm, table("a [mm]", "250")).rows
    [finding] = first.entries[0].findings
    assert (finding.code, finding.hint) == (
        "converted_length", "Read as 250 mm, as the header says.",
    )  # fmt: skip
    assert second.entries[0].findings == ()


def test_an_exercise_with_several_units_converts_nothing(make_exercise: Maker) -> None:
    exercise = make_exercise(ARM.replace("UNIT", "m", 1).replace("UNIT", "mm"))
    [first, second] = read(exercise, table("a [mm]", "250")).rows
    assert first.entries[0].verdict is Verdict.UNREADABLE
    assert second.entries[0].readable


def test_the_exercise_may_have_millimetres(make_exercise: Maker) -> None:
    exercise = make_exercise(ARM.replace("UNIT", "mm"))
    assert read(exercise, table("a (mm)", "250")).rows[0].values[0] == pytest.approx(250)
    assert read(exercise, table("a (m)", "0.25")).rows[0].values[0] == pytest.approx(250)


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
    [finding] = read(arm, table(head, "0.25 m")).rows[0].entries[0].findings
    assert finding.suggestion == suggestion
