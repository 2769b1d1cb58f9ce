"""The program recognises its own documents, and nothing that students hand in."""

import io
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from dh_grader.formats import FORMAT_NAMES, report_format
from dh_grader.formats.class_page import (
    WRITTEN,
    feedback_zip,
    is_document,
    is_earlier_output,
    is_output,
)
from dh_grader.formats.documents import HTML
from dh_grader.submissions.files import MAX_START, all_handed_in
from dh_grader.translations import LANGUAGES

from tests.formats.class_of_seven import class_of_seven
from tests.formats.submissions import cases, document, setting
from tests.formats.test_worksheets import BLACKBOARD, CANVAS, WORDS, moodle
from tests.submissions.handins.answers import PARTS, right
from tests.submissions.handins.files import KINDS
from tests.together import together


@pytest.mark.long
@together("name", sorted(FORMAT_NAMES))
@together("case", cases())
def test_every_document_of_every_format_is_recognised(name: str, case: str) -> None:
    written = document(name, cases()[case])
    # The text report on an unusable file is empty: its problem is on standard error.
    assert not written or is_document(written.encode(errors="replace")[:MAX_START])


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_documents_of_a_class_are_recognised_in_every_language(language: str) -> None:
    own = setting(language=LANGUAGES[language])
    for name in FORMAT_NAMES:
        if not report_format(name).is_single:
            for submissions in (class_of_seven(), class_of_seven() * 2):
                pieces = report_format(name).pieces(submissions, own)
                assert is_document(b"".join(pieces)[:MAX_START]), name


def left_out(folder: Path) -> tuple[Sequence[str], Sequence[str]]:
    """Return the names of the entries that are left out, and the learners."""
    outputs: list[str] = []
    found = all_handed_in([folder], is_output=is_output, outputs=outputs)
    learners = [each.learner for each in found]
    return sorted(Path(path).name for path in outputs), learners


def write_all(folder: Path) -> list[str]:
    """Write all outputs and worksheets into a folder; return the names of its entries."""
    own = setting()
    for name in FORMAT_NAMES:
        given = class_of_seven()[:1] if report_format(name).is_single else class_of_seven()
        content = b"".join(report_format(name).pieces(given, own))
        (folder / f"out-{name}").write_bytes(content)
    (folder / "feedback.zip").write_bytes(
        b"".join(feedback_zip(class_of_seven(), own, HTML.pieces))
    )
    assert HTML.folder is not None
    with zipfile.ZipFile(folder / "all.zip", "w") as archive:
        for each in HTML.folder(class_of_seven(), own):
            content = b"".join(each.pieces)
            for path in (folder / "class" / each.path, folder / "pages" / Path(each.path).name):
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
            archive.writestr(each.path, content)
    (folder / "pages" / "index.html").rename(folder / "overview.html")
    for i, words in enumerate(WORDS.values()):
        (folder / f"Grades {i}.csv").write_bytes(moodle(words))
    (folder / "Canvas.csv").write_text(CANVAS, encoding="utf-8")
    (folder / "gc_HW1.xls").write_bytes(BLACKBOARD.encode("utf-16"))
    return sorted(path.name for path in folder.iterdir())


def test_all_outputs_and_worksheets_in_the_folder_of_a_class_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    names = write_all(tmp_path / "in")
    (tmp_path / "in" / "anna.csv").write_text("a, alpha, d, theta\n0, 0, 0, q1\n", encoding="utf-8")
    assert left_out(tmp_path / "in") == (names, ["anna"])
    # The tutor packs the folder, and unpacks it elsewhere.
    with zipfile.ZipFile(tmp_path / "again.zip", "w") as archive:
        for path in (tmp_path / "in").rglob("*"):
            archive.write(path, f"in/{path.relative_to(tmp_path / 'in')}")
    assert left_out(tmp_path / "again.zip") == (names, ["anna"])


def test_what_a_run_has_written_into_the_folder_of_a_student_leaves_the_student(
    tmp_path: Path,
) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / "anna" / "table.csv").write_text("0", encoding="utf-8")
    (tmp_path / "anna" / "page.html").write_text("0", encoding="utf-8")
    (tmp_path / "anna" / WRITTEN).write_text("page.html\n", encoding="utf-8")
    assert left_out(tmp_path) == ([], ["anna"])


@pytest.mark.long
def test_no_hand_in_of_a_student_is_taken_for_an_output(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    count = 0
    for exercise, parts in PARTS.items():
        for part in parts:
            answer = right(exercise, part)
            for kind in KINDS:
                made = kind.make(answer, rng)
                if not made.target:
                    (tmp_path / f"s{count}{made.ending}").write_bytes(made.content)
                    count += 1
    assert count > 500
    names, learners = left_out(tmp_path)
    assert names == []
    assert len(learners) == count


@pytest.mark.parametrize(
    "content", [b"a;b\n1;2\n", b"PK\x03\x04", b"# notes\n\nanswers", b"{}", b"[]", b"\xff\xfe"]
)
def test_a_file_of_somebody_else_is_no_earlier_output(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "file"
    file.write_bytes(content)
    assert not is_earlier_output(file)
    file.write_bytes(b"")
    assert is_earlier_output(file)


def test_a_worksheet_is_no_earlier_output(tmp_path: Path) -> None:
    file = tmp_path / "Grades.csv"
    file.write_bytes(moodle(WORDS["en"]))
    assert not is_earlier_output(file)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("Ada_1_assignsubmission_file_/table.csv", "0")
    file.write_bytes(packed.getvalue())
    assert not is_earlier_output(file)
