"""A pasted table keeps its robot, is refused, or is asked about."""

import math
import tomllib
from dataclasses import replace

import pytest
from dh_grader.authoring import Level, examine
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.load import read_exercise
from dh_grader.grading.grade import Submission, grade
from dh_grader.importing import ImportedRobot, ImportOptions, RefusedRobotError, imported_table
from dh_grader.kinematics import Convention

from tests.importing.tables.drawn import EXERCISES

PASTED = """
i | a [m] | alpha | d [m] | theta
1 | 0 | -90°  | d1 | q1
2 | -a2 | 0   | 0  | q2 + 90°
3 | 0 | 90°   | q3 | 0
e | 0 | 0     | 0.1 | 180°
"""
HEAD = "a | alpha | d | theta\n"
OPTIONS = ImportOptions(title="A robot", source="A table")


def imported(text: str, **choices: str) -> ImportedRobot:
    return imported_table(text, OPTIONS.with_answers(choices))


def rows(text: str, **choices: str) -> list[list[str]]:
    """Return the table in the file of an imported table."""
    made = imported(text, **choices)
    assert not made.questions
    table: list[list[str]] = tomllib.loads(made.text)["robot"]["table"]
    return table


def exercise(text: str) -> Exercise:
    return read_exercise(EXERCISES / "imported.toml", text)


def full_marks(made: ImportedRobot, answer: str) -> bool:
    report = grade(exercise(made.text), Submission({"table": answer}))
    return report.parts[0].points == report.parts[0].max_points


def test_a_pasted_table_becomes_an_exercise_that_accepts_it() -> None:
    made = imported(PASTED)
    assert exercise(made.text).structure == "RRP"
    assert full_marks(made, PASTED)


KEPT = {
    "offset of a slide": (
        HEAD + "0 | 0 | d1 + q1 | 0\nL0 | 0 | 0 | q2\n",
        [["0", "0", "q1 + d1", "0"], ["L0", "0", "0", "theta2"]],
    ),
    "q without number": (
        HEAD + "0 | 90° | l1 + q | 0\nh | 0 | 0 | q\n",
        [["0", "90deg", "d1 + l1", "0"], ["h", "0", "0", "theta2"]],
    ),
    "own letters": (
        HEAD + "l_{arm} | 0 | L_0 | q1\n\\ell_2 | 0 | -2h | q2\n",
        [["l_arm", "0", "L_0", "theta1"], ["l_2", "0", "-2 h", "theta2"]],
    ),
    "equal links": (
        HEAD + "l | 0 | 0 | q1\nl | 0 | l/2 + H | q2\n",
        [["l", "0", "0", "theta1"], ["l", "0", "H + 0.5 l", "theta2"]],
    ),
    "large and small letters": (
        HEAD + "l1 | 0 | 0 | q1\nL1 | 0 | 0 | q2\n",
        [["l1", "0", "0", "theta1"], ["L1", "0", "0", "theta2"]],
    ),
    "a marked variable": (
        HEAD + "0 | 90° | h | \\theta_1^*\n0 | 0 | d_2^* + e1 | 0\n",
        [["0", "90deg", "h", "theta1"], ["0", "0", "d_2 + e1", "0"]],
    ),
    "seven decimals": (
        "a [mm] | alpha | d | theta\n" + "131.2345678 | 0 | 0 | q1\n",
        [["0.1312345678", "0", "0", "theta1"]],
    ),
    "offset": (
        "theta | d | a | alpha | offset\nq1|h|0|pi/2|0\nq2|0|r|0|-pi/2\n0|q3|0|0|l3\n",
        [["0", "90deg", "h", "theta1"], ["r", "0", "0", "theta2 - 90deg"],
         ["0", "0", "d3 + l3", "0"]],
    ),
    "theta_offset": (
        "θ | theta_offset [deg] | d | a | α\nq1|-90|h|0|pi/2\n",
        [["0", "90deg", "h", "theta1 - 90deg"]],
    ),
    "new headers": (
        "Links | R | ∝ | d_z | φ_i\n1 | 0 | 90° | h | q1\n", [["0", "90deg", "h", "theta1"]],
    ),
    "L for the link length": (
        "Links | L | ∝ | d_z | φ_i\n1 | r | 90° | h | q1\n", [["r", "90deg", "h", "theta1"]],
    ),
    "L for the number": (
        "L | a | ∝ | d_z | φ_i\n2 | 0 | 0 | 0 | q2\n1 | r | 90° | h | q1\n",
        [["r", "90deg", "h", "theta1"], ["0", "0", "0", "theta2"]],
    ),
    "fixed row between joints": (
        HEAD + "0 | 0 | h | q1\nr | 90° | 0 | 0\nl | 0 | 0 | q2\n",
        [["r", "90deg", "h", "theta1"], ["l", "0", "0", "theta2"]],
    ),
    "reversed joint": (
        HEAD + "0 | 90° | h | q1\nr | 0 | l | 90° - q2\n",
        [["0", "-90deg", "h", "theta1"], ["r", "180deg", "-l", "theta2 - 90deg"]],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", KEPT)
def test_what_a_table_says_is_kept(name: str) -> None:
    text, table = KEPT[name]
    # The variable d_2 of a sliding joint has the name d2 in the file.
    assert rows(text) == [[cell.replace("d_2", "d2") for cell in row] for row in table]


def test_a_file_with_a_reversed_joint_accepts_the_pasted_table() -> None:
    text = KEPT["reversed joint"][0]
    made = imported(text)
    assert full_marks(made, text)
    assert not [each for each in examine(exercise(made.text)) if each.level is Level.FAILED]


def test_the_first_joint_of_a_modified_table_may_be_reversed() -> None:
    text = HEAD + "0 | 180° | h | q1\nr | 90° | 0 | -q2\n"
    made = imported_table(text, replace(OPTIONS, convention=Convention.MODIFIED))
    assert tomllib.loads(made.text)["robot"]["table"][0] == ["0", "180deg", "h", "theta1"]
    assert full_marks(made, text)


SNAPS = {
    "1.5708": "90deg", "1.57": "90deg", "1.571": "90deg", "0.785": "45deg", "-3.1416": "-180deg",
    "0.26": "15deg", "1.57080001": "90deg", "1.57rad": "90deg", "89.9999deg": "90deg",
    "0.7847": None, "1.6": None, "0.79": "45deg", "0.784": None, "45.01deg": None,
}  # fmt: skip


@pytest.mark.parametrize("written", SNAPS)
def test_a_rounded_multiple_becomes_exact_and_is_listed(written: str) -> None:
    text = f"{HEAD}0 | {written} | h | q1\nr | 90° | 0 | q2 + {written}\n"
    made = imported(text, angles="radians")
    first, second = tomllib.loads(made.text)["robot"]["table"]
    snaps = [each for each in made.remarks if "became" in each]
    file = [line for line in made.text.splitlines() if "became" in line]
    if SNAPS[written] is None:
        assert (snaps, file) == ([], [])
        is_degrees = written.endswith("deg")
        number = float(written.removesuffix("deg"))
        assert (
            first[1] == f"{number if is_degrees else math.degrees(number):.10f}".rstrip("0") + "deg"
        )
        return
    assert first[1] == SNAPS[written]
    assert second[3].replace(" ", "") == f"theta2+{SNAPS[written]}".replace("+-", "-")
    assert [each.split(":")[0] for each in snaps] == ["row 1, column alpha", "row 2, column theta"]
    assert [f"# {each}" for each in snaps] == file


def test_a_students_90_degrees_fit_a_table_in_rounded_radians() -> None:
    made = imported(HEAD + "0 | 1.5708 | h | q1\nr | 0 | 0 | q2\n")
    assert full_marks(made, HEAD + "0 | 90deg | h | q1\nr | 0 | 0 | q2\n")


ASKED = {
    "order": ("0 90° h q1\nr 0 0 q2\n", "alpha a d theta"),
    "unit": (HEAD + "0 | 90° | 131.2 | q1\n", "mm"),
    "angles": (HEAD + "0 | 90 | h | q1\n", "degrees"),
    "convention": ("a_{i-1} | α_{i-1} | d | θ\n0 | 0 | h | q1\n", "modified"),
}


@pytest.mark.parametrize("name", ASKED)
def test_what_a_table_does_not_say_is_asked(name: str) -> None:
    text, answer = ASKED[name]
    made = imported(text)
    [question] = made.questions
    assert (question.name, made.text, answer in question.choices) == (name, "", True)


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (HEAD + "0 | 90 | 131.2 | q1\n", ["unit", "angles"]),
        (HEAD + "0 | 90° | 0.2 | q1\n", ["unit"]),
        (HEAD + "0 | 90° | 0.2 + q1 | 0\n", ["unit"]),
        (HEAD + "0 | 2 | h | q1\n", ["angles"]),
        (HEAD + "0 | 90° | h | q1 - 45\n", ["angles"]),
        (HEAD + "0 | pi/2 | h | q1 - 45\n", ["angles"]),
        (HEAD + "0 | 1.5708 | h | q1 + 1.2\n", []),
        (HEAD + "0 | 1.2 | h | q1\n", ["angles"]),
        (HEAD + "0 | 0.7847 | h | q1\n", []),
        ("Modified DH table\n" + HEAD + "0 | 0 | h | q1\n", ["convention"]),
        ("All lengths in mm.\n" + HEAD + "0 | 90° | 131.2 | q1\n", []),
        ("% theta d a alpha\nDH = [q1 h 0 pi/2; q2 0 r 0];\n", []),
    ],
)
def test_only_what_is_open_is_asked(text: str, names: list[str]) -> None:
    assert [question.name for question in imported(text).questions] == names


def test_an_answer_is_used() -> None:
    text = HEAD + "0 | 90 | 131.2 | q1\n"
    assert rows(text, unit="mm", angles="degrees") == [["0", "90deg", "0.1312", "theta1"]]
    swapped = "0 90° h q1\n0 0 0 q2\n"
    with pytest.raises(RefusedRobotError, match="row 1, column a: this is an angle"):
        rows(swapped, order="alpha a d theta")
    assert rows("0 0.2 h q1\n90° 0 0 q2\n", order="α a d θ", unit="cm")[0][0] == "0.002"


def test_the_unit_and_the_notes_of_the_reader_are_told() -> None:
    made = imported("a (mm) | alpha | d (mm) | theta | type\n100 | 1.5708 | 5 | q1 | R\n")
    told = "\n".join(made.remarks)
    assert "The numbers of column a are in mm." in told
    assert "Angles without a unit are in radians." in told
    assert "The column `type` was ignored." in told
    assert "Largest difference to the table at 100 poses: " in told
    made = imported("q1 h 0 90°\nq2 0 r 0\n", order="theta d a alpha")
    assert "The columns were read in the order θ, d, a, α." in made.remarks


REFUSED = {
    "0 | 0 | 0 | 0": "row 1 has no joint variable; write q1 into its column theta",
    "0 | 0 | l1*l2 | q1": "row 1, column d: write a sum of numbers, letters",
    "0 | 0 | d1+ | q1": "row 1, column d",
    "0 | 0 | 0 | -q1\nr | 0 | 0 | q2": "row 1 counts the joint variable negative",
    "h | h | 0 | q1": "row 1, column alpha: this is the letter of a length",
    "90° | 0 | 0 | q1": "row 1, column a: this is an angle",
    "0 | 0 | 0 | 2*q1": "row 1, column theta: write the joint variable once",
    "0 | 0 | 0 | q1\n0 | 0 | 0 | q1 + q2":
        "row 2, column theta: this is the joint variable of another row",
    "0 | 0 | 0 | q1\n0 | 0 | q1 | q2":
        "row 2, column d: this is the joint variable of another row",
    "0 | 90° | d1 | 0\nd1 | 0 | 0 | q2":
        "row 2, column a: this is the joint variable of another row",
    "0 | 0 | q1 | q1": "row 1, column d: this row also has a joint variable in theta",
    "0 | 0 | d1* | theta1": "row 1, column d: this row also has a joint variable in theta",
    "0 | 0 | 0 | q1\n0 | 0 | 0 | 0\n0 | 0 | 0 | q3": "row 2 has no joint variable; write q2",
    "0 | 0 | 0 | q0\n0 | 0 | 0 | q1": "row 1 has the variable of another joint; its own is q1",
    "r | 0 | h | q1\nr | 90° | h | 0\nr | 0 | 0 | q2": "row 2 has no joint variable, and cannot be",
    "O | 0 | h | q1": "row 1, column a",
    "0 | 90000 | h | q1": "row 1, column alpha: the angle is more than two turns",
    "good morning": "",
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSED)
def test_a_table_without_a_robot_is_refused_with_its_reason(text: str) -> None:
    with pytest.raises(RefusedRobotError) as refused:
        imported(HEAD + text, angles="radians")
    assert str(refused.value).startswith(REFUSED[text])


@pytest.mark.parametrize(
    "text",
    [
        "type | a | alpha | d | theta\nR | 0 | 90° | h | 0\nR | r | 0 | 0 | 0\n",
        "a | alpha | d | theta | joint type\n0|90°|h|q1|revolute\nr|0|0|0|revolute\n",
        "a | alpha | d | theta | joint type\n0|90°|h|q1|revolute\n0|0|d2|0|revolute\n",
    ],
)
def test_a_type_without_a_variable_is_refused_with_advice(text: str) -> None:
    with pytest.raises(
        RefusedRobotError, match=r"write q\d into its column theta if the joint turns"
    ):
        imported(text)


def test_a_script_of_the_other_convention_is_not_read_as_the_chosen_one() -> None:
    script = "robot = DHRobot([RevoluteMDH(a=0.2, alpha=0.1), RevoluteMDH(d=0.3)])"
    with pytest.raises(RefusedRobotError, match="makes a table of the modified convention"):
        imported_table(script, replace(OPTIONS, convention=Convention.STANDARD, unit="m"))
    made = imported(script, unit="m", angles="radians")
    assert tomllib.loads(made.text)["robot"]["convention"] == "modified"
