"""An answer of which hardly anything was read gets no points, and a person gets the reason."""

import io
import json
import zipfile
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

import pytest
import xlsxwriter
from dh_grader.catalogue import FeedbackLevel
from dh_grader.formats import report_format
from dh_grader.formats.graded import GradedSubmission, GradingTerms, Setting, graded
from dh_grader.formats.worksheets import grade_of
from dh_grader.submissions import of_one
from dh_grader.submissions.files import all_handed_in
from rich.console import Console

from tests.submissions import office_documents as made
from tests.submissions.test_office_files import RIGHT, RRR, grade_files

HEADERS: Final = ["i", "a", "alpha", "d", "theta"]
TEMPLATE: Final[made.Rows] = [HEADERS, *([str(i), "", "", "", ""] for i in range(1, 5))]
HALF: Final[made.Rows] = [RIGHT[0], *RIGHT[1:3], [""] * 4, [""] * 4]
ZEROS: Final[made.Rows] = [RIGHT[0], *[[0, 0, 0, 0]] * 4]
PHOTO: Final = {"IMG_1.jpg": b"\xff\xd8\xff\0"}
SCAN: Final = {"scan.pdf": b"%PDF-1.4 \0"}


def csv(rows: made.Rows) -> bytes:
    return "\n".join(",".join(map(str, row)) for row in rows).encode()


def web_page(rows: made.Rows) -> bytes:
    lines = ("".join(f"<td>{cell}</td>" for cell in row) for row in rows)
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>".encode()


def drawn(rows: made.Rows, *, box: bool = False) -> bytes:
    """Return a workbook with a picture or a text box in its sheet."""
    written = io.BytesIO()
    book = xlsxwriter.Workbook(written, {"in_memory": True})
    sheet = book.add_worksheet()
    for i, row in enumerate(rows):
        sheet.write_row(i, 0, ["" if cell == "" else cell for cell in row])
    if box:
        sheet.insert_textbox("G2", csv(RIGHT).decode())
    else:
        sheet.insert_image("G2", "x.png", {"image_data": io.BytesIO(PNG)})
    book.close()
    return written.getvalue()


# One white pixel.
PNG: Final = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de"
    "0000000c4944415408d763f8ffff3f0005fe02fedccc59e70000000049454e44ae426082"
)

UNREAD: Final[dict[str, dict[str, bytes]]] = {
    "a template": {"t.xlsx": made.xlsx(TEMPLATE)},
    "a template of text": {"t.csv": csv(TEMPLATE)},
    "a template in a document": {"t.docx": made.docx_table(TEMPLATE)},
    "a template and a photo": {"t.xlsx": made.xlsx(TEMPLATE)} | PHOTO,
    "a template of text and a scan": {"t.csv": csv(TEMPLATE)} | SCAN,
    "a typed template and a photo": {"onlinetext.html": web_page(TEMPLATE)} | PHOTO,
    "a template with a picture": {"t.xlsx": drawn(TEMPLATE)},
    "a template with a text box": {"t.xlsx": drawn(TEMPLATE, box=True)},
    "words only": {"t.txt": b"I hand my answer in on paper.\n"},
    "half a table and a photo": {"t.xlsx": made.xlsx(HALF)} | PHOTO,
    "half a table with a picture": {"t.xlsx": drawn(HALF)},
    "half a table with a text box": {"t.xlsx": drawn(HALF, box=True)},
    "zeros and a photo": {"t.xlsx": made.xlsx(ZEROS)} | PHOTO,
    "a photo": PHOTO,
}  # fmt: skip


@pytest.mark.parametrize("case", UNREAD)
def test_what_was_not_read_is_left_to_a_person_in_every_format(tmp_path: Path, case: str) -> None:
    found = grade_files(tmp_path, UNREAD[case])
    assert not found.is_complete
    [reason] = found.problems
    grade = grade_of(found, "")
    assert (grade.share, grade.reasons) == (None, (reason,))
    # The file of points, the gradebook, and JSON.
    assert written("csv", found).splitlines()[1].split(",")[1] == ""
    assert written("gradebook", found).splitlines()[1].split(",")[1] == ""
    [entry] = json.loads(written("json", found))
    assert entry["error"]
    for name in PHOTO | SCAN:
        assert (name in str(reason)) is (name in UNREAD[case])


@pytest.mark.parametrize("level", FeedbackLevel)
def test_the_level_of_feedback_does_not_decide_who_grades(
    tmp_path: Path, level: FeedbackLevel
) -> None:
    for case in ("a template", "half a table and a photo", "zeros and a photo"):
        folder = tmp_path / case / "class" / "Ada_1_assignsubmission_file"
        folder.mkdir(parents=True)
        for name, content in UNREAD[case].items():
            (folder / name).write_bytes(content)
        [handed] = all_handed_in([folder.parent])
        found = graded(handed, GradingTerms(of_one(RRR, "table"), 0.8, level))
        assert not found.is_complete


def written(name: str, *submissions: GradedSubmission) -> str:
    console = Console(file=io.StringIO(), width=100)
    setting = Setting((submissions[0].files[0].exercise,), console, datetime.now(UTC))
    return b"".join(report_format(name).pieces(submissions, setting)).decode()


READ: Final[dict[str, tuple[dict[str, bytes], float]]] = {
    # Nothing else was handed in, so that what is missing is missing.
    "half a table": ({"t.xlsx": made.xlsx(HALF)}, 3.0),
    "zeros": ({"t.xlsx": made.xlsx(ZEROS)}, 0.0),
    "a right table and a photo": ({"t.xlsx": made.xlsx(RIGHT)} | PHOTO, 8.0),
    "a right table with a picture": ({"t.xlsx": drawn(RIGHT)}, 8.0),
    "a right table and a damaged one": ({"t.csv": csv(RIGHT), "u.docx": b"PK\3\4"}, 8.0),
}  # fmt: skip


@pytest.mark.parametrize("case", READ)
def test_what_was_read_counts_and_files_beside_it_are_named(tmp_path: Path, case: str) -> None:
    files, points = READ[case]
    found = grade_files(tmp_path, files)
    assert (found.points, found.is_complete, found.problems) == (points, True, ())
    others = [name for name in files if not name.startswith("t.")]
    assert [sentence.split(" ")[0] for sentence in found.beside] == others
    [entry] = json.loads(written("json", found))
    assert entry.get("unread", []) == [str(each) for each in found.beside]
    assert grade_of(found, "").has_unread_files is bool(others)


def test_an_empty_file_for_one_of_several_parts_is_left_to_a_person(tmp_path: Path) -> None:
    files = {"table.csv": csv(RIGHT), "pose.csv": b", , , \n, , , \n, , , \n, , , \n"}
    found = in_all_parts(tmp_path, files)
    assert not found.is_complete
    assert "pose.csv" in found.problems[0]


def in_all_parts(folder: Path, files: dict[str, bytes]) -> Any:
    student = folder / "class" / "Ada_1_assignsubmission_file"
    student.mkdir(parents=True)
    for name, content in files.items():
        (student / name).write_bytes(content)
    [handed] = all_handed_in([folder / "class"])
    return graded(handed, GradingTerms(of_one(RRR, None), 0.8))


def test_a_part_without_a_file_is_missing(tmp_path: Path) -> None:
    found = in_all_parts(tmp_path, {"table.csv": csv(RIGHT)})
    assert (found.is_complete, found.problems) == (True, ())


def formula(value: str) -> bytes:
    rows: Sequence[Sequence[str | float]] = [*RIGHT[:2], ["l1", value, 0, "q2"], *RIGHT[3:]]
    return csv(rows)


@pytest.mark.parametrize(
    "value",
    [
        "#NAME?",
        "#REF!",
        "#DIV/0!",
        "#VALUE!",
        "#NUM!",
        "#N/A",
        "#NULL!",
        "#SPILL!",
        "Err:508",
        "#BEZUG!",
        "#WERT!",
        "#NV",
        "#¿NOMBRE?",
        "#¡REF!",
        "#NOM?",
    ],
)
def test_a_formula_that_gave_no_value_is_not_wrong(tmp_path: Path, value: str) -> None:
    found = grade_files(tmp_path, {"t.csv": formula(value)})
    assert not found.is_complete
    [reason] = found.problems
    assert reason == f"t.csv has a formula that gave no value ({value}), so grade it by hand"


def test_a_failed_formula_of_a_workbook_is_not_wrong(tmp_path: Path) -> None:
    rows: made.Rows = [*RIGHT[:2], ["l1", "#NAME?", 0, "q2"], *RIGHT[3:]]
    found = grade_files(tmp_path, {"t.xlsx": made.xlsx(rows)})
    assert "#NAME?" in found.problems[0]


@pytest.mark.parametrize("name", ["t.exe", "t.bin", "t.rar", "t.7z", "t.xlsb"])
def test_a_file_of_an_unknown_kind_is_named_by_its_kind(tmp_path: Path, name: str) -> None:
    found = grade_files(tmp_path, {name: b"MZ\x90\0\3\0"})
    [reason] = found.problems
    assert f".{name.partition('.')[2]}" in reason
    assert "this program" in reason


@pytest.mark.parametrize("name", ["table.xlsm", "table.docm"])
def test_a_file_with_macros_is_read_without_them(tmp_path: Path, name: str) -> None:
    make = made.xlsx if name.endswith(".xlsm") else made.docx_table
    content = io.BytesIO(make(RIGHT))
    with zipfile.ZipFile(content, "a") as archive:
        archive.writestr(f"{'xl' if 'xls' in name else 'word'}/vbaProject.bin", b"\0macro")
    found = grade_files(tmp_path, {name: content.getvalue()})
    assert (found.points, found.problems) == (8, ())
