"""A sentence beside a table that may change its meaning; nobody but a person can apply it."""

import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path

import docx
import openpyxl
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.formats.local_grading import GradingTerms, graded
from dh_grader.grading import Submission, grade
from dh_grader.submissions import of_one
from dh_grader.submissions.documents import changing_remark
from dh_grader.submissions.files import all_handed_in

HEAD = ("a", "alpha", "d", "theta")
DEGREES = (
    HEAD, ("a1", "0", "0", "theta1"), ("a2", "180", "0", "theta2"), ("0", "0", "d3", "0"),
    ("0", "0", "d4", "theta4"),
)  # fmt: skip
RADIANS = tuple(tuple(cell.replace("180", "pi") for cell in row) for row in DEGREES)

Rows = tuple[tuple[str, ...], ...]


def markdown(rows: Rows, said: str) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|---|---|---|---|", *lines[1:], "", said, ""])


def latex(rows: Rows, said: str) -> str:
    body = " \\\\\n".join(" & ".join(row) for row in rows)
    return f"% {said}\n\\begin{{tabular}}{{cccc}}\n{body}\n\\end{{tabular}}\nName\n"


def web_page(rows: Rows, said: str) -> str:
    cells = "".join("<tr><td>" + "</td><td>".join(row) + "</td></tr>" for row in rows)
    return f"<p>Hello</p><table>{cells}</table><p>{said}</p>"


def notebook(rows: Rows, said: str) -> str:
    cells = [
        {"cell_type": "markdown", "metadata": {}, "source": [text]}
        for text in (said, markdown(rows, ""))
    ]
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


def rich_text(rows: Rows, said: str) -> str:
    cells = "".join("".join(rf"\intbl {cell}\cell " for cell in row) + r"\row " for row in rows)
    return rf"{{\rtf1\ansi {said}\par {cells}}}"


def word(rows: Rows, said: str) -> bytes:
    document = docx.Document()
    document.add_paragraph(said)
    table = document.add_table(rows=0, cols=4)
    for row in rows:
        for cell, text in zip(table.add_row().cells, row, strict=True):
            cell.text = text
    return saved(document)


def workbook(rows: Rows, said: str) -> bytes:
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.active["G3"] = said
    return saved(book)


def below(rows: Rows, said: str) -> bytes:
    book = openpyxl.Workbook()
    for row in (*rows, (), (said,)):
        book.active.append(row)
    return saved(book)


def saved(document: object) -> bytes:
    content = io.BytesIO()
    document.save(content)  # type: ignore[attr-defined]
    return content.getvalue()


WRITERS: Mapping[str, Callable[[Rows, str], str | bytes]] = {
    "table.md": markdown, "table.tex": latex, "table.html": web_page, "table.ipynb": notebook,
    "table.rtf": rich_text, "table.docx": word, "table.xlsx": workbook, "below.xlsx": below,
}  # fmt: skip


def problem(folder: Path, scara: Exercise, name: str, rows: Rows, said: str) -> tuple[str, float]:
    """Return the problem of a file with a sentence beside the table, and its points."""
    content = WRITERS[name](rows, said)
    file = folder / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    [handed] = all_handed_in([file])
    found = graded(handed, GradingTerms(of_one(scara, "table"), 0.8))
    return "; ".join(found.problems), found.points


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize(
    "said",
    [
        "All angles are in degrees.", "Alle Winkel in Grad.", "a and d are swapped",
        "Sorry, row 4 is wrong.", "Korrektur: in Zeile 4 muss d = d4 stehen.",
    ],
)  # fmt: skip
def test_a_sentence_that_may_change_the_table_is_left_to_a_person(
    name: str,
    said: str,
    tmp_path: Path,
    catalogue: Mapping[str, Exercise],
) -> None:
    found, _ = problem(tmp_path, catalogue["scara"], name, DEGREES, said)
    assert "grade it by hand" in found
    assert said in found


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize(
    "said",
    [
        "DH table of the SCARA robot", "Anna Schmidt, Matrikelnummer 1234567",
        "The angles of the joints are variable.", "Lengths in m, angles in rad",
        "All angles are in degrees.", "The robot has four degrees of freedom.",
        "The z axis is turned by 180 degrees.", "Each row of the table must be filled in.",
        "The table should be in the standard convention.", "Inverse kinematics of the SCARA",
        "The joint variables theta1 and theta2 must be named.",
    ],
)  # fmt: skip
def test_other_prose_changes_nothing(
    name: str,
    said: str,
    tmp_path: Path,
    catalogue: Mapping[str, Exercise],
) -> None:
    assert problem(tmp_path, catalogue["scara"], name, RADIANS, said) == ("", 8)


TABLE = "i, a, alpha, d, theta\n1, 0.3, {alpha}, 0, q1\n2, 0.2, 0, 0, q2\n"


@pytest.mark.parametrize(
    ("table", "said", "unit", "changes"),
    [
        (TABLE.format(alpha="90"), "angles in degrees", "m", True),
        (TABLE.format(alpha="pi/2"), "angles in degrees", "m", False),
        (TABLE.format(alpha="1.5708"), "Lengths in m, angles in rad", "m", False),
        (TABLE.format(alpha="0"), "lengths in metres", "m", False),
        (TABLE.format(alpha="0"), "lengths in centimetres", "m", True),
        (TABLE.format(alpha="0"), "lengths in centimetres", None, True),
        (TABLE.format(alpha="90").replace("alpha", "alpha [deg]"), "in degrees", "m", False),
        ("0, 90, 0, q1\n0.2, 0, 0, q2", "in degrees", "m", True),
        ("0, pi/2, 0, q1\n0.2, 0, 0, q2", "in degrees", "m", False),
        ("[cos(q1), 0; 0, 1]", "in degrees", "m", False),
        ("l1, 0, 0, q1 + 90\n0, 0, 0, q2", "角度的单位是度。", "m", True),
        ("l1, 90°, 0, q1\n0, 0, 0, q2", "Les angles sont en degrés.", "m", False),
    ],
)
def test_a_unit_concerns_numbers_without_a_unit(
    table: str, said: str, unit: str | None, changes: bool
) -> None:
    assert bool(changing_remark(table, [said], unit)) is changes


@pytest.mark.parametrize("remark", ["a and d are swapped", "Row 4 is wrong.", "第4行写错了"])
@pytest.mark.parametrize(
    "text", ["{remark}\n\n{table}", "{table}\n\n{remark}", "# {remark}\nDH = [{rows}]"]
)
def test_a_correction_in_a_pasted_text_is_refused(
    remark: str, text: str, catalogue: Mapping[str, Exercise]
) -> None:
    table = "\n".join(", ".join(row) for row in RADIANS)
    rows = ", ".join(f"[{', '.join(row)}]" for row in RADIANS[1:])
    answer = text.format(remark=remark, table=table, rows=rows)
    report = grade(catalogue["scara"], Submission({"table": answer})).parts[0]
    assert "text_around" in [each.code for each in report.feedback]
