"""Grades go into the files of platforms; a reader with the rules of Moodle's importer finds them.

The headings are those of Moodle's language packs, version 4.5.
"""

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass, replace

import pytest
from dh_grader import grading
from dh_grader.formats.graded import GradedFile, GradedSubmission, answered
from dh_grader.formats.worksheets import (
    Grade,
    UnusableWorksheetError,
    Worksheet,
    grade_of,
    is_worksheet,
)
from dh_grader.grading import Submission

from tests.formats.submissions import planar


@dataclass(frozen=True)
class Words:
    """What Moodle writes in one language."""

    identifier: str
    name: str
    status: str
    grade: str
    maximum: str
    can_be_changed: str
    submission_time: str
    grade_time: str
    comments: str
    participant: str
    submitted: str
    yes: str
    date: str
    comma: bool


WORDS = {
    "en": Words(
        "Identifier", "Full name", "Status", "Grade", "Maximum grade", "Grade can be changed",
        "Last modified (submission)", "Last modified (grade)", "Feedback comments", "Participant ",
        "Submitted for grading", "Yes", "Saturday, 3 October 2026, 2:05 PM", comma=False,
    ),
    "de": Words(
        "ID", "Vollständiger Name", "Status", "Bewertung", "Bestwertung",
        "Bewertung kann geändert werden", "Zuletzt geändert (Abgabe)",
        "Zuletzt geändert (Bewertung)", "Feedback als Kommentar", "Teilnehmer/in",
        "Zur Bewertung abgegeben", "Ja", "Samstag, 3. Oktober 2026, 14:05", comma=True,
    ),
    "es": Words(
        "Identificador", "Nombre completo", "Estado", "Calificación", "Calificación máxima",
        "La calificación puede ser cambiada", "Última modificación (entrega)",
        "Última modificación (calificación)", "Comentarios de retroalimentación", "Participante",
        "Enviado para calificar", "Sí", "sábado, 3 de octubre de 2026, 14:05", comma=True,
    ),
    "fr": Words(
        "Identifiant", "Nom complet", "Statut", "Note", "Note maximale",
        "La note peut être modifiée", "Dernière modification (travail remis)",
        "Dernière modification (note)", "Feedback par commentaires", "Participant",
        "Remis pour évaluation", "Oui", "samedi 3 octobre 2026, 14:05", comma=True,
    ),
    "zh": Words(
        "标识符", "全名", "状态", "成绩", "最高分", "允许更改成绩", "上次修改（作业）",
        "上次修改（评分）", "反馈意见", "参与人", "已提交请评分", "是",
        "2026年10月3日 星期六 14:05", comma=False,
    ),
}  # fmt: skip

ADA = Grade("in/Ada Byron_1234", "Participant 1234", 7 / 8, 7.0, 8.0, "Table: 7 / 8")
BEN = Grade("in/Ben Okri_1235", "Participant 1235", 7 / 24, 7 / 3, 8.0, 'Table: "2.33" / 8; a, b')
UNREAD = Grade(
    "in/Cy Young_1236", "Participant 1236", None, 0.0, 8.0, "", reasons=("t.pdf was not read",)
)


def moodle(words: Words, separator: str = ",", most: str = "8.00") -> bytes:
    most = most.replace(".", ",") if words.comma else most
    head = [
        words.identifier, words.name, "ID number", words.status, words.grade, words.maximum,
        words.can_be_changed, words.submission_time, words.grade_time, words.comments,
    ]  # fmt: skip
    students = [("Ada Byron", "1234"), ("Ben Okri", "1235"), ("Cy Young", "1236"), ("Di", "1237")]
    rows = [
        [f"{words.participant}{number}", name, "77", words.submitted, "", most, words.yes,
         words.date, "-", ""]
        for name, number in students
    ]  # fmt: skip
    written = io.StringIO(newline="")
    csv.writer(written, delimiter=separator, lineterminator="\n").writerows([head, *rows])
    return b"\xef\xbb\xbf" + written.getvalue().encode()


def filled(
    grades: Iterable[Grade], before: bytes, column: str | None = None, *, replaces: bool = False
) -> tuple[bytes, list[str]]:
    found = Worksheet(before, column).filled(grades, replaces=replaces)
    return found.content, list(found.problems)


def imported(content: bytes, words: Words, separator: str) -> dict[int, tuple[float | None, str]]:
    """Return the grades and comments by participant, by the rules of Moodle's importer.

    It compares headings with those of the user's language, cuts the length of the word
    "Participant" from the identifier, refuses lines of another length and a file without the
    identifier, the grade or the time of the grade, and skips grades that are empty or too high.
    """
    head, *rows = csv.reader(io.StringIO(content.decode("utf-8-sig")), delimiter=separator)
    assert all(len(row) == len(head) for row in rows)
    id_, grade, _ = (head.index(each) for each in (words.identifier, words.grade, words.grade_time))
    comments = head.index(words.comments)
    found = {}
    for row in rows:
        number = int(row[id_][len(words.participant) :])
        value = row[grade].replace(",", ".") if words.comma else row[grade]
        points = float(value) if value else None
        assert points is None or 0 <= points <= 8
        found[number] = (points, row[comments])
    return found


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("language", WORDS)
def test_moodles_importer_reads_the_grades(language: str, separator: str) -> None:
    words = WORDS[language]
    content, problems = filled([ADA, BEN, UNREAD], moodle(words, separator))
    assert imported(content, words, separator) == {
        1234: (7.0, "Table: 7 / 8"),
        1235: (2.33, 'Table: "2.33" / 8; a, b'),
        # What was not read is graded by hand, and who handed nothing in stays.
        1236: (None, ""),
        1237: (None, ""),
    }
    [heading, problem] = problems
    assert "by hand" in heading
    assert problem == "Cy Young_1236: t.pdf was not read"


@pytest.mark.parametrize("language", WORDS)
def test_all_else_stays_byte_for_byte(language: str) -> None:
    before = moodle(WORDS[language])
    after, _ = filled([ADA], before)
    comma = WORDS[language].comma
    lines = before.split(b"\n")
    most = b'"8,00"' if comma else b"8.00"
    lines[1] = lines[1].replace(b",," + most, b",7," + most)
    assert lines[1].endswith(b"-,")
    lines[1] += b"Table: 7 / 8"
    assert after == b"\n".join(lines)
    assert filled([], before)[0] == before


def test_points_are_scaled_to_the_maximum_of_the_worksheet() -> None:
    words = WORDS["en"]
    after, _ = filled([BEN], moodle(words, most="100.00"))
    assert b",29.17,100.00," in after


def test_points_have_the_decimal_comma_of_the_worksheet() -> None:
    after, _ = filled([BEN], moodle(WORDS["de"]))
    assert b',"2,33","8,00",' in after


def test_a_comment_is_no_formula_of_a_spreadsheet() -> None:
    after, _ = filled([replace(ADA, comment="=1+1")], moodle(WORDS["en"]))
    assert b",-,'=1+1\n" in after


def test_a_worksheet_without_the_time_of_grades_is_refused() -> None:
    words = WORDS["en"]
    rows = list(csv.reader(io.StringIO(moodle(words).decode("utf-8-sig"))))
    written = io.StringIO()
    csv.writer(written).writerows([row[:7] for row in rows])
    with pytest.raises(UnusableWorksheetError, match="last modified"):
        Worksheet(written.getvalue().encode())


def test_the_number_of_a_group_is_not_the_number_of_a_student() -> None:
    group = Grade("in/Group 3_1234", "Participant 1234", 1.0, 8.0, 8.0, "")
    before = moodle(WORDS["en"])
    after, [problem] = filled([group], before)
    assert after == before
    assert problem == "in/Group 3_1234 is in no row of the worksheet. Enter 8 / 8 points by hand."


def test_letters_that_a_spreadsheet_program_lost_are_any_letters() -> None:
    # Excel saved the worksheet in Windows-1252, which has neither ễ nor ł.
    worksheet = moodle(WORDS["en"]).replace(b"Ada Byron", b"Nguy?n ?ucja")
    lost = Grade("in/Nguyễn Łucja_1234", "Participant 1234", 1.0, 8.0, 8.0, "")
    after, problems = filled([lost], worksheet)
    assert problems == []
    assert imported(after, WORDS["en"], ",")[1234] == (8.0, "")
    other = Grade("in/Nguyen Anna_1234", "Participant 1234", 1.0, 8.0, 8.0, "")
    assert filled([other], worksheet)[0] == worksheet


def test_two_submissions_of_one_student_fill_nothing() -> None:
    before = moodle(WORDS["en"])
    after, problems = filled([ADA, ADA], before)
    assert after == before
    assert len(problems) == 2


def test_anonymous_worksheets_have_no_names() -> None:
    text = (
        "Identifier,Status,Grade,Maximum Grade,Grade can be changed,"
        "Last modified (submission),Last modified (grade),Feedback comments\r\n"
        "Participant 1234,Submitted for grading,,8.00,Yes,"
        '"Saturday, 3 October 2026, 2:05 PM",-,\r\n'
    )
    anonymous = Grade("in/Participant 1234_1234", "Participant 1234", 0.5, 4, 8, "ok")
    after, problems = filled([anonymous], text.encode())
    assert after.decode() == text.replace("grading,,", "grading,4,").replace("-,\r", "-,ok\r")
    assert problems == []


CANVAS = (
    "Student,ID,SIS User ID,SIS Login ID,Section,HW 1 (501),HW 2 (502),Final Score\r\n"
    ",,,,,Manual Posting,,\r\n"
    "    Points Possible,,,,,16.00,8.00,(read only)\r\n"
    '"Lee, Ann",11,,,A,,,0\r\n'
    '"Lee, Ann",12,s12,ann2,B,,,0\r\n'
    '"Roe, Cy",13,s13,cy,B,EX,,0\r\n'
    '"Student, Test",14,,x,B,,,0\r\n'
)


def test_canvas_students_of_one_name_are_told_apart_by_id() -> None:
    grades = [
        Grade("in/leeann_12", "12", 1.0, 8.0, 8.0, "c"),
        Grade("in/leeann_11", "11", 0.25, 2.0, 8.0, "c"),
        Grade("in/roecy_13", "13", 0.25, 2.0, 8.0, "c"),
        Grade("in/who_15", "15", 0.25, 2.0, 8.0, "c"),
    ]
    after, problems = filled(grades, CANVAS.encode(), "HW 1")
    # A row without a login is filled like the others.
    wanted = CANVAS.replace("11,,,A,,", "11,,,A,4,").replace("ann2,B,,", "ann2,B,16,")
    assert after.decode() == wanted
    assert sorted(problems) == [
        "in/roecy_13 is from an excused student. The row stays as it was.",
        "in/who_15 is in no row of the worksheet. Enter 2 / 8 points by hand.",
    ]


def test_the_column_of_a_gradebook_is_never_guessed() -> None:
    with pytest.raises(UnusableWorksheetError, match=r"HW 1 \(501\), HW 2 \(502\)"):
        Worksheet(CANVAS.encode())
    with pytest.raises(UnusableWorksheetError):
        Worksheet(CANVAS.encode(), "HW 7")


BRIGHTSPACE = (
    "OrgDefinedId,Username,Last Name,First Name,"
    "HW 1 Points Grade <Numeric MaxPoints:10 Weight:5 Category:Home>,End-of-Line Indicator\r\n"
    "#9001,#abyron,Byron,Ada,,#\r\n"
    "#9002,#alee,Lee,Ann,,#\r\n"
    "#9003,#alee2,Lee,Ann,,#\r\n"
)


def test_brightspace_finds_students_by_name_if_the_name_is_unique() -> None:
    ada = Grade("in/Ada Byron_75-12", "Ada Byron", 0.75, 6.0, 8.0, "c")
    ann = Grade("in/Ann Lee_76-13", "Ann Lee", 0.75, 6.0, 8.0, "c")
    after, [problem] = filled([ada, ann], BRIGHTSPACE.encode())
    assert after.decode() == BRIGHTSPACE.replace("Ada,,", "Ada,7.5,")
    assert "Ann Lee" in problem
    assert "2 rows" in problem


BLACKBOARD = (
    '"Last Name"\t"First Name"\t"Username"\t"Student ID"\t"Last Access"\t"Availability"\t'
    '"HW1 [Total Pts: 8 Score] |123"\n'
    '"Byron"\t"Ada"\t"abyron"\t""\t"2026-10-01 10:00:00"\t"Yes"\t""\n'
    '"Lee"\t"Ann"\t"a_lee"\t""\t""\t"Yes"\t""\n'
    '"Lee"\t"Bo"\t"b_lee"\t""\t""\t"Yes"\t""\n'
)


def test_blackboards_file_in_utf_16() -> None:
    before = b"\xff\xfe" + BLACKBOARD.encode("utf-16-le")
    ada = Grade("in/HW1_abyron", "abyron", 0.75, 6.0, 8.0, "c")
    lee = Grade("in/HW1_a_lee", "lee", 0.75, 6.0, 8.0, "c")
    after, [problem] = filled([ada, lee], before)
    wanted = BLACKBOARD.replace('00"\t"Yes"\t""', '00"\t"Yes"\t"6"')
    assert after == b"\xff\xfe" + wanted.encode("utf-16-le")
    assert "a_lee" in problem
    assert "2 rows" in problem


@pytest.mark.parametrize(
    "content", [b"", b"\xef\xbb\xbf", b"\xff\xfe\x00", b"a,b\n1,2\n", b"PK\x03\x04\0\0", b"\n"]
)
def test_other_files_are_refused(content: bytes) -> None:
    with pytest.raises(UnusableWorksheetError):
        Worksheet(content)


def with_grades(*grades: str, comment: str = "") -> bytes:
    """Return a worksheet of Moodle in which somebody has entered these grades."""
    head, *rows = list(csv.reader(io.StringIO(moodle(WORDS["en"]).decode("utf-8-sig"))))
    for row, grade in zip(rows, grades, strict=False):
        row[4], row[-1] = grade, comment if grade else ""
    written = io.StringIO(newline="")
    csv.writer(written, lineterminator="\n").writerows([head, *rows])
    return written.getvalue().encode()


KEPT = (
    "1 row of the worksheet already had another grade, which stays (grade in the worksheet / grade "
    "of the program): Ada Byron_1234 (5.00 / 7)."
)


def test_a_grade_that_a_person_entered_stays_unless_it_shall_be_replaced() -> None:
    before = with_grades("5.00", "2.33", comment="well done")
    sheet = Worksheet(before)
    found = sheet.filled([ADA, BEN])
    # Ben's grade is the same, and the comments of a person stay, too.
    assert found.content == before
    assert (found.grades, found.same, found.kept) == (0, 1, 1)
    assert list(found.problems) == [
        KEPT,
        "1 comment that was already in the worksheet stays.",
    ]
    replaced = sheet.filled([ADA, BEN], replaces=True)
    assert (replaced.grades, replaced.same, replaced.kept) == (1, 1, 0)
    assert replaced.problems == (
        "1 grade in the worksheet is replaced (old → new): Ada Byron_1234 (5.00 → 7).",
        "2 comments in the worksheet are replaced: Ada Byron_1234, Ben Okri_1235.",
    )
    assert imported(replaced.content, WORDS["en"], ",") == {
        1234: (7.0, "Table: 7 / 8"),
        1235: (2.33, 'Table: "2.33" / 8; a, b'),
        1236: (None, ""),
        1237: (None, ""),
    }


def test_a_comment_of_a_person_stays_beside_a_new_grade() -> None:
    lines = moodle(WORDS["en"]).decode().splitlines(keepends=True)
    lines[1] = lines[1].replace("-,\n", "-,see me\n")
    content, [problem] = filled([ADA], "".join(lines).encode())
    assert imported(content, WORDS["en"], ",")[1234] == (7.0, "see me")
    assert problem == "1 comment that was already in the worksheet stays."


def test_a_row_that_a_person_has_graded_is_not_left_for_grading_by_hand() -> None:
    found = Worksheet(with_grades("", "", "6.00")).filled([UNREAD])
    assert (found.by_hand, found.problems) == (0, ())


def test_what_was_not_read_has_no_points_to_enter() -> None:
    stranger = replace(UNREAD, name="in/Eve_99", learner="Participant 99")
    for grades in ([stranger], [UNREAD, UNREAD]):
        _, problems = filled(grades, moodle(WORDS["en"]))
        for problem in problems:
            assert problem.endswith("Grade it by hand.")
            assert "?" not in problem


def test_the_worksheet_of_another_course_gets_one_sentence() -> None:
    grades = [Grade(f"in/S{i}_{i}", f"Participant {i}", 1.0, 8.0, 8.0, "") for i in range(900, 930)]
    found = Worksheet(moodle(WORDS["en"])).filled(grades)
    assert found.is_foreign
    [problem] = found.problems
    assert problem.startswith(
        "None of the 30 submissions is in the worksheet (S900_900, S901_901, S902_902, …)."
    )
    partly = Worksheet(moodle(WORDS["en"])).filled([ADA, *grades])
    assert not partly.is_foreign
    [problem] = partly.problems
    assert problem.startswith(
        "30 submissions are in no row of the worksheet (S900_900, S901_901, S902_902, …)."
    )


SCALE = (
    "Identifier,Full name,Status,Grade,Scale,Grade can be changed,"
    "Last modified (submission),Last modified (grade),Feedback comments\n"
    'Participant 1234,Ada Byron,Submitted,,"Not yet, Good",Yes,-,-,\n'
    'Participant 1235,Ben Okri,Submitted,,"Not yet, Good",Yes,-,-,\n'
)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (SCALE.encode(), r"grades by a scale \(Not yet, Good\)"),
        (moodle(WORDS["en"]).replace(b",8.00,", b',"8,00",', 2), r"spellings \(8,00, 8.00\)"),
        (moodle(WORDS["en"]).partition(b"\n")[0] + b"\n", "only a heading"),
        (CANVAS.partition("\n")[0].encode(), "only a heading"),
    ],
)
def test_a_worksheet_that_cannot_be_filled_says_why(content: bytes, reason: str) -> None:
    with pytest.raises(UnusableWorksheetError, match=reason):
        Worksheet(content)


def test_the_maximum_decides_about_the_decimal_sign() -> None:
    # Somebody has typed a grade with another decimal sign.
    before = with_grades("6,5")
    content, _ = filled([BEN], before)
    assert imported(content.replace(b"6,5", b"6.5"), WORDS["en"], ",")[1235][0] == 2.33


@pytest.mark.parametrize(
    ("sheet", "name", "learner", "person"),
    [
        (moodle(WORDS["de"]), "in/Ada Byron_1234", "Participant 1234", "Ada Byron"),
        (CANVAS.encode(), "in/leeann_12", "12", "Lee, Ann"),
        (BLACKBOARD.encode("utf-16"), "in/HW1_abyron", "abyron", "Ada Byron"),
        (moodle(WORDS["de"]), "in/Eve_99", "Participant 99", ""),
    ],
)
def test_the_worksheet_knows_the_names(sheet: bytes, name: str, learner: str, person: str) -> None:
    assert Worksheet(sheet, "HW 1" if b"HW 1 (" in sheet else None).person(name, learner) == person


def test_worksheets_are_recognised_by_their_beginning() -> None:
    for words in WORDS.values():
        assert is_worksheet(moodle(words)[:600])
    for text in (CANVAS, BRIGHTSPACE, BLACKBOARD, SCALE):
        assert is_worksheet(text.encode())
    assert is_worksheet(BLACKBOARD.encode("utf-16"))
    for table in (
        "i,a,alpha,d,theta\n1,0,0,0,q1\n",
        "Joint 1,a1,0,0,theta1\nJoint 2,a2,180,0,theta2\nJoint 3,0,0,d3,0\n",
        "Link 1;0;90;8;-\nLink 2;0;90;8;-\n",
        "1;2;3\n",
    ):
        assert not is_worksheet(table.encode())


def test_replaced_grades_and_comments_are_named_each() -> None:
    words = WORDS["en"]
    before, _ = filled([ADA, BEN], moodle(words))
    regraded = [replace(ADA, share=4 / 8, points=4.0, comment="Table: 4 / 8"), BEN]
    found = Worksheet(before).filled(regraded, replaces=True)
    assert list(found.problems) == [
        "1 grade in the worksheet is replaced (old → new): Ada Byron_1234 (7 → 4).",
        "1 comment in the worksheet is replaced: Ada Byron_1234.",
    ]
    # Ben's grade was already there.
    assert (found.grades, found.same) == (1, 1)


def test_emptied_cells_are_filled_without_replacing_others() -> None:
    words = WORDS["en"]
    before, _ = filled([ADA, BEN], moodle(words))
    emptied = before.replace(b",7,8.00", b",,8.00").replace(b"Table: 7 / 8", b"")
    assert emptied != before
    regraded = [replace(each, share=4 / 8, points=4.0, comment="new") for each in (ADA, BEN)]
    after = imported(Worksheet(emptied).filled(regraded).content, words, ",")
    assert after[1234] == (4.0, "new")
    assert after[1235] == imported(before, words, ",")[1235]


def test_submissions_with_unread_entries_are_named() -> None:
    unread = replace(BEN, has_unread_cells=True)
    _, problems = filled([ADA, unread], moodle(WORDS["en"]))
    assert problems == [
        (
            "1 submission has entries that could not be read, and earned no points for them: "
            "Ben Okri_1235."
        )
    ]


@pytest.mark.parametrize(
    ("cells", "share", "has_unread"),
    [
        # Half of the sixteen cells; all but one of a row that has nothing else; a few.
        (["1..2"] * 8 + ["0"] * 8, None, True),
        (["1..2"] * 3 + ["0"] + [""] * 12, None, True),
        (["1..2"] * 2 + ["0"] * 14, float, True),
        (["0"] * 16, float, False),
    ],
)
def test_an_answer_of_which_most_was_not_read_gets_no_grade(
    cells: list[str], share: type[float] | None, has_unread: bool
) -> None:
    lines = [", ".join(cells[i : i + 4]) for i in range(0, 16, 4)]
    text = "\n".join(["a, alpha, d, theta", *lines])
    report = grading.grade(planar(), Submission({"table": text}))
    file = GradedFile("table.csv", answered(planar()), report)
    found = grade_of(GradedSubmission("in/Ada_1", "Participant 1", (file,), 0.8), "")
    assert (found.share is None) is (share is None)
    assert found.has_unread_cells is has_unread
