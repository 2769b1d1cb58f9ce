"""Test whole texts that students paste."""

from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.expressions import AngleUnit, Vocabulary, joint_variable
from dh_grader.formats.graded import GradingTerms, graded
from dh_grader.grading import PartReport, Severity, Submission, grade
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading import preview_pasted
from dh_grader.grading.reading.entries import Reader, pasted_grid
from dh_grader.grading.report import Verdict
from dh_grader.pasting import GridError, read_grid
from dh_grader.submissions import of_one
from dh_grader.submissions.files import all_handed_in

from tests.grading.reading.pasted_texts import languages, reading_of, texts
from tests.grading.support.robots import COLUMNS, RRRP, SCARA, STANFORD, Robot, in_pi
from tests.grading.support.submitting import full_marks, handed_in, part, table

# --- Write a textbook robot's table as a script for a robotics toolbox


def cells(robot: Robot) -> list[dict[str, str]]:
    found = []
    for row in robot.rows:
        named = dict(zip(COLUMNS, row, strict=True))
        named["alpha"] = in_pi(int(named["alpha"]))
        found.append({name: "" if "*" in cell else cell for name, cell in named.items()})
    return found


def in_matlab(robot: Robot) -> str:
    """Return a script with vectors [θ d a α σ] for MATLAB's toolbox."""
    lines = [
        f"L({i}) = Link([{row['theta'] or 0} {row['d'] or 0} {row['a']} {row['alpha']} "
        f"{int(not row['d'])}]);"
        for i, row in enumerate(cells(robot), 1)
    ]
    return "\n".join(["clear, close all", *lines, "robot = SerialLink(L);", "robot.teach()"])


def by_name(robot: Robot) -> str:
    lines = []
    for row in cells(robot):
        given = ", ".join(f"'{name}', {cell}" for name, cell in row.items() if cell)
        lines.append(f"    Link({given})")
    return "\n".join(["robot = SerialLink([", *lines, "]);"])


def in_python(robot: Robot) -> str:
    """Return a script for the Robotics Toolbox for Python."""
    lines = []
    for row in cells(robot):
        kind = "Revolute" if row["d"] else "Prismatic"
        given = ", ".join(f"{name}={cell}" for name, cell in row.items() if cell not in ("", "0"))
        lines.append(f"    rtb.{kind}DH({given}),")
    return "\n".join(["import roboticstoolbox as rtb", "robot = rtb.DHRobot([", *lines, "])"])


def of_bodies(robot: Robot) -> str:
    """Return a script for MATLAB's Robotics System Toolbox."""
    lines = []
    for i, row in enumerate(cells(robot), 1):
        kind = "revolute" if row["d"] else "prismatic"
        values = " ".join(row[name] or "0" for name in COLUMNS)
        lines.append(f"jnt{i} = rigidBodyJoint('jnt{i}', '{kind}');")
        lines.append(f"setFixedTransform(jnt{i}, [{values}], 'dh');")
    return "\n".join(["robot = rigidBodyTree;", *lines])


def by_column(robot: Robot) -> str:
    columns = ((name, i) for i, name in enumerate(COLUMNS))
    lists = ", ".join(
        f"'{name}': [{', '.join(_value(name, row[i]) for row in robot.rows)}]"
        for name, i in columns
    )
    return f"import pandas as pd\ndh = pd.DataFrame({{{lists}}})"


def _value(name: str, cell: str) -> str:
    return in_pi(int(cell)) if name == "alpha" else cell.removesuffix("*")


# --- Read square brackets and decimal commas in pasted texts


def pasted_cells(text: str) -> list[str]:
    reader = Reader(Vocabulary([joint_variable(i) for i in (1, 2, 3)]), Samples({}), "radians", "m")
    entries = [reader.read(cell.text, "number") for cell in pasted_grid(text, reader).rows[0]]
    return [entry.expression.text() for entry in entries if entry.expression]


def test_a_joint_with_index_0_counts_from_0() -> None:
    assert pasted_cells("q[0], q[1]") == ["theta1", "theta2"]


def test_the_number_of_the_last_joint_counts_from_1() -> None:
    assert pasted_cells("theta[1], theta[3]") == ["theta1", "theta3"]


@pytest.mark.parametrize("text", ["q[1], 0", "cos(q[1]), sin(q[2])", "θ[2], 1"])
def test_other_indices_have_two_readings(text: str) -> None:
    with pytest.raises(GridError) as caught:
        pasted_cells(text)
    assert caught.value.code == "ambiguous_index"


# --- decimal commas


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("0,5;1\n2,25;l1", [["0.5", "1"], ["2.25", "l1"]]),
        ("0,5;0.25\n2;3", [["0.5", "0.25"], ["2", "3"]]),
        ("0,5\t1,000\n2\tl1", [["0.5", "1.000"], ["2", "l1"]]),
        ("-0,5l1;cos(0,5)\n2*1,25;atan2(1,5)", [["-0.5l1", "cos(0,5)"], ["2*1.25", "atan2(1,5)"]]),
        ("|a, mm|alpha|\n|---|---|\n|12,5|q1|", [["a, mm", "alpha"], ["12.5", "q1"]]),
        # Thousands, points beside commas, lists, or one line: no comma is certain.
        ("1,000;2\n12,500;3", [["1,000", "2"], ["12,500", "3"]]),
        ("1,2,3;0,5\n2;3", [["1,2,3", "0,5"], ["2", "3"]]),
        ("1, 2;0,5\n2;3", [["1, 2", "0,5"], ["2", "3"]]),
        ("q1,5;0,5\n2;3", [["q1,5", "0,5"], ["2", "3"]]),
    ],
)
def test_a_comma_is_a_decimal_comma_only_where_nothing_else_fits(
    text: str, read: list[list[str]]
) -> None:
    assert [[cell.text for cell in row] for row in read_grid(text, of_table=True).rows] == read


def test_a_decimal_comma_in_a_cell_keeps_its_place() -> None:
    cell = read_grid("0,5;1\n2,25;l1", of_table=True).rows[1][0]
    assert (cell.text, cell.whole) == ("2.25", (6, 10))


# The table of the UR5e as its maker prints it, in the language of a German spreadsheet.
ROWS = (
    ("0", "90°", "0,1625", "theta1"),
    ("-0,425", "0", "0", "theta2"),
    ("-0,3922", "0", "0", "theta3"),
    ("0", "90°", "0,1333", "theta4"),
    ("0", "-90°", "0,0997", "theta5"),
    ("0", "0", "0,0996", "theta6"),
)
PASTED_COLUMNS = ("a", "alpha", "d", "theta")


@pytest.fixture
def arm(make_exercise: Callable[[str], Exercise]) -> Callable[[bool], Exercise]:
    def made(allowed: bool) -> Exercise:
        text = (shipped_folder() / "ur5e.toml").read_text(encoding="utf-8")
        return make_exercise(f"decimal_comma = {str(allowed).lower()}\n{text}")

    return made


SHAPES: dict[str, Any] = {
    "cells": {"rows": [dict(zip(PASTED_COLUMNS, row, strict=True)) for row in ROWS]},
    "spreadsheet": {"rows": "\n".join(map("\t".join, ROWS))},
    "csv": {"rows": "\n".join(map(";".join, ROWS))},
    "markdown": {"rows": "\n".join(f"| {' | '.join(row)} |" for row in ROWS)},
    "quoted": {"rows": "\n".join(",".join(f'"{cell}"' for cell in row) for row in ROWS)},
    "spaces": {"rows": "\n".join(map("  ".join, ROWS))},
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_table_with_decimal_commas_has_full_marks(
    arm: Callable[[bool], Exercise], shape: str
) -> None:
    [report, *_] = grade(arm(True), Submission({"table": SHAPES[shape]})).parts
    assert report.points == report.max_points


@pytest.mark.parametrize("shape", ["spreadsheet", "csv", "markdown", "quoted"])
def test_between_other_signs_than_commas_a_decimal_comma_is_read_with_a_note(
    arm: Callable[[bool], Exercise], shape: str
) -> None:
    [report, *_] = grade(arm(False), Submission({"table": SHAPES[shape]})).parts
    assert report.points == report.max_points
    notes = [finding for finding in report.feedback if finding.code == "decimal_comma_read"]
    assert [str(note.message) for note in notes] == [
        "`0,1625` is read as 0.1625: the comma is a decimal comma."
    ]


@pytest.mark.parametrize("shape", ["cells", "spaces"])
def test_elsewhere_no_decimal_comma_is_read_without_leave(
    arm: Callable[[bool], Exercise], shape: str
) -> None:
    [report, *_] = grade(arm(False), Submission({"table": SHAPES[shape]})).parts
    assert report.verdict is not Verdict.CORRECT
    cells = [cell for row in report.rows for cell in row.cells]
    assert all(cell.verdict is not Verdict.INCORRECT for cell in cells)


def test_a_wrong_length_is_wrong(arm: Callable[[bool], Exercise]) -> None:
    rows = [dict(row) for row in SHAPES["cells"]["rows"]]
    rows[1]["a"] = "-0,452"
    [report, *_] = grade(arm(True), Submission({"table": {"rows": rows}})).parts
    wrong = [
        (row.label, c.label)
        for row in report.rows
        for c in row.cells
        if c.verdict is not Verdict.CORRECT
    ]
    assert wrong == [("2", "a")]


# --- Pasted texts in five languages are read as meant, or refused with advice

LEAST_TEXTS = 500
LEAST_READ = 0.9


@pytest.mark.parametrize("language", languages())
def test_no_text_is_misread_and_each_refused_one_has_advice(language: str) -> None:
    for case in texts(language):
        reading = reading_of(case)
        assert reading.outcome != "misread", (case.title, reading.advice)
        if not case.rows:
            assert reading.outcome == "advised", case.title
        elif reading.outcome != "read":
            assert reading.advice, case.title
            assert not any(advice.startswith("no_grid") for advice in reading.advice), case.title


@pytest.mark.parametrize("file", ["around", "named"])
def test_each_text_of_a_form_that_is_read_keeps_its_meaning(file: str) -> None:
    for case in texts(file):
        reading = reading_of(case)
        assert reading.outcome == ("read" if case.rows else "advised"), (case.title, reading)


@pytest.mark.long
def test_most_texts_are_read(figure: Callable[[str], None]) -> None:
    found = [case for language in languages() for case in texts(language) if case.rows]
    total = sum(len(texts(language)) for language in languages())
    counts = Counter(reading_of(case).outcome for case in found)
    figure(f"{total} pasted texts, {len(found)} with a meaning: {dict(counts)}")
    assert total >= LEAST_TEXTS
    assert counts["read"] / len(found) >= LEAST_READ


@pytest.mark.parametrize("language", languages())
def test_the_preview_shows_rows_or_a_problem(
    language: str, catalogue: Mapping[str, Exercise]
) -> None:
    part = {"matrix": ("planar-rrr", "pose"), "position": ("planar-rr", "position")}
    for case in texts(language):
        exercise, part_id = part.get(case.kind, ("rrrp", "table"))
        preview = preview_pasted(case.text, catalogue[exercise], part_id)
        assert preview.rows or (preview.problem and preview.problem.message), case.title


# --- Grade a script for a robotics toolbox as the table of its links

ROBOTS = (RRRP, SCARA, STANFORD)


def graded_script(
    exercise: Exercise, answer: object, angle_unit: AngleUnit = "radians"
) -> PartReport:
    return part(handed_in(exercise, {"table": answer}, angle_unit), "table")


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.exercise)
@pytest.mark.parametrize("write", [in_matlab, by_name, in_python, of_bodies, by_column])
def test_a_script_gets_full_marks_and_fills_the_same_rows(
    write: Callable[[Robot], str], robot: Robot, catalogue: Mapping[str, Exercise]
) -> None:
    exercise, text = catalogue[robot.exercise], write(robot)
    report = graded_script(exercise, text)
    assert full_marks(report), report
    assert {message.severity for message in report.feedback} <= {Severity.INFO}
    preview = preview_pasted(text, exercise, "table")
    assert preview.ok
    assert full_marks(
        graded_script(exercise, table([cell.entry for cell in row] for row in preview.rows))
    )


def test_a_script_is_in_radians_regardless_of_the_submission(
    catalogue: Mapping[str, Exercise],
) -> None:
    exercise = catalogue[SCARA.exercise]
    text = in_matlab(SCARA).replace("a2 pi", "a2 3.141592653589793")
    text = text.replace("0]);", "0 6.283185307179586]);", 1)
    assert full_marks(graded_script(exercise, text, "degrees"))
    rows = preview_pasted(text, exercise, "table", "degrees").rows
    assert (rows[0][3].entry, rows[1][1].entry) == (
        "theta1 + 6.283185307179586rad",
        "3.141592653589793rad",
    )
    entries = table([cell.entry for cell in row] for row in rows)
    assert full_marks(graded_script(exercise, entries, "degrees"))


def test_a_script_in_the_other_convention_gets_a_message(catalogue: Mapping[str, Exercise]) -> None:
    text = in_matlab(RRRP).replace("]);", "], 'modified');")
    report = graded_script(catalogue[RRRP.exercise], text)
    assert full_marks(report)
    assert "convention_not_asked_for" in [message.code for message in report.feedback]


def test_a_slip_is_found_in_its_link(catalogue: Mapping[str, Exercise]) -> None:
    text = in_matlab(SCARA).replace("a2 pi", "a2 0")
    report = graded_script(catalogue[SCARA.exercise], text)
    wrong = [
        (row.label, cell.label)
        for row in report.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    ]
    assert wrong == [("2", "alpha")]


def test_a_script_is_not_a_matrix(catalogue: Mapping[str, Exercise]) -> None:
    report = part(handed_in(catalogue[RRRP.exercise], {"pose": in_matlab(RRRP)}), "pose")
    assert report.verdict is Verdict.UNREADABLE


# --- Texts with several answers to one part: a first try, and what replaced it

Rows = tuple[tuple[str, ...], ...]

HEAD = ("i", "a", "alpha", "d", "theta")
SEVERAL_ANSWERS_ROWS = (
    ("1", "a1", "0", "0", "theta1"), ("2", "a2", "180deg", "0", "theta2"),
    ("3", "0", "0", "d3", "0"), ("4", "0", "0", "d4", "theta4"),
)  # fmt: skip
TRY = (SEVERAL_ANSWERS_ROWS[0], ("2", "a2", "0", "0", "theta2"), *SEVERAL_ANSWERS_ROWS[2:])
# The same numbers in other words.
AGAIN = (SEVERAL_ANSWERS_ROWS[0], ("2", "a2", "pi", "0", "q2"), *SEVERAL_ANSWERS_ROWS[2:])
POSE = """c123 -s123 0 l1*c1+l2*c12+l3*c123
s123 c123 0 l1*s1+l2*s12+l3*s123
0 0 1 0
0 0 0 1"""


def csv(rows: Rows) -> str:
    return "\n".join(", ".join(row) for row in (HEAD, *rows))


def blanks(rows: Rows) -> str:
    return "\n".join(" ".join(row[1:]) for row in rows)


def bars(rows: Rows) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in (HEAD, ("---",) * 5, *rows))


def latex(rows: Rows) -> str:
    body = " \\\\\n".join(" & ".join(row) for row in (HEAD, *rows))
    return f"\\begin{{tabular}}{{ccccc}}\n{body}\n\\end{{tabular}}"


def matlab(rows: Rows) -> str:
    return f"DH{len(str(rows))} = [{'; '.join(' '.join(row[1:]) for row in rows)}];"


def table_of_several(catalogue: Mapping[str, Exercise], text: str) -> PartReport:
    return grade(catalogue["scara"], Submission({"table": text})).parts[0]


def refusal(report: PartReport) -> str:
    assert report.verdict is Verdict.UNREADABLE
    [message] = report.feedback
    assert message.code == "several_answers"
    return message.message


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (f"{csv(TRY)}\n\n{csv(SEVERAL_ANSWERS_ROWS)}", "1-5 and 7-11"),
        (f"{csv(TRY)}\n{csv(SEVERAL_ANSWERS_ROWS)}", "1-5 and 6-10"),
        (f"\n\n{csv(TRY)}\n\n\n{csv(SEVERAL_ANSWERS_ROWS)}", "3-7 and 10-14"),
        (
            f"My first try\n{csv(TRY)}\n\nCorrected table:\n\n{csv(SEVERAL_ANSWERS_ROWS)}\n",
            "2-6 and 10-14",
        ),
        (f"{blanks(TRY)}\n\n{blanks(SEVERAL_ANSWERS_ROWS)}", "1-4 and 6-9"),
        (f"{blanks(TRY)}\n{blanks(SEVERAL_ANSWERS_ROWS)}", "1-4 and 5-8"),
        (f"First\n{blanks(TRY)}\nSecond\n{blanks(SEVERAL_ANSWERS_ROWS)}", "2-5 and 7-10"),
        (f"{bars(TRY)}\n\nThe second try\n\n{bars(SEVERAL_ANSWERS_ROWS)}", "1-6 and 10-15"),
        (f"First\n{latex(TRY)}\n\nSecond\n{latex(SEVERAL_ANSWERS_ROWS)}", "2-8 and 11-17"),
        (f"{matlab(TRY)}\n% better\n{matlab(SEVERAL_ANSWERS_ROWS)}", "1 and 3"),
        (f"{csv(TRY)}\n\n{csv(SEVERAL_ANSWERS_ROWS)}\n\n{csv(TRY)}", "1-5, 7-11 and 13-17"),
        # A try without its last row.
        (f"{csv(TRY[:3])}\n\n{csv(SEVERAL_ANSWERS_ROWS)}", "1-4 and 6-10"),
    ],
)
def test_several_tables_that_differ_are_named_by_their_lines(
    text: str, lines: str, catalogue: Mapping[str, Exercise]
) -> None:
    assert f"in the lines {lines}." in refusal(table_of_several(catalogue, text))


@pytest.mark.parametrize("again", [SEVERAL_ANSWERS_ROWS, AGAIN])
@pytest.mark.parametrize("layout", [csv, blanks, bars, latex, matlab])
def test_equal_tables_are_one_answer(
    layout: Callable[[Rows], str], again: Rows, catalogue: Mapping[str, Exercise]
) -> None:
    report = table_of_several(
        catalogue, f"Draft\n{layout(SEVERAL_ANSWERS_ROWS)}\n\nFinal version\n{layout(again)}"
    )
    assert report.points == report.max_points
    assert "answer_repeated" in [message.code for message in report.feedback]


def test_matrices_that_differ_are_refused_and_equal_ones_are_one(
    catalogue: Mapping[str, Exercise],
) -> None:
    def pose(text: str) -> PartReport:
        return grade(catalogue["planar-rrr"], Submission({"pose": text})).parts[1]

    wrong = POSE.replace("-s123", "s123")
    assert "in the lines 2-5 and 8-11." in refusal(pose(f"First\n{wrong}\n\nBetter:\n{POSE}"))
    report = pose(f"{POSE}\n\n{POSE}")
    assert report.points == report.max_points


@pytest.mark.parametrize(
    "rows",
    [
        # One table with an empty line in it.
        f"{blanks(SEVERAL_ANSWERS_ROWS[:2])}\n\n{blanks(SEVERAL_ANSWERS_ROWS[2:])}",
        f"{csv(SEVERAL_ANSWERS_ROWS[:2])}\n\n{csv(SEVERAL_ANSWERS_ROWS[2:]).partition(chr(10))[2]}",
    ],
)
def test_one_table_in_two_blocks_is_one_answer(
    rows: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = table_of_several(catalogue, rows)
    assert report.points == report.max_points


def test_rows_behind_the_last_joint_are_no_second_table(
    catalogue: Mapping[str, Exercise],
) -> None:
    # Two joints, each with a fixed row behind it.
    text = "0 0 0 q1\na1 0 0 0\n\n0 0 0 q2\na2 0 0 0"
    report = grade(catalogue["planar-rr"], Submission({"table": text})).parts[0]
    assert "several_answers" not in [message.code for message in report.feedback]


def test_a_file_with_two_tables_is_graded_by_hand_and_not_with_zero_points(
    tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    (tmp_path / "Anna.txt").write_text(
        f"\n{csv(TRY)}\n\nThis one counts\n{csv(SEVERAL_ANSWERS_ROWS)}\n"
    )
    assignment = of_one(catalogue["scara"], "table")
    [handed] = all_handed_in([tmp_path])
    found = graded(handed, GradingTerms(assignment, 0.8))
    assert not found.is_complete
    [file] = found.files
    assert file.report is not None
    assert "in the lines 2-6 and 9-13." in refusal(file.report.parts[0])
