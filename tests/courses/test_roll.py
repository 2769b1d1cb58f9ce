"""Test lists of a class, and names."""

import codecs
from dataclasses import dataclass

import pytest
from dh_grader.contract.courses import CourseLearner
from dh_grader.courses import CourseError, decoded, place_of, read_class_list, told_apart

from tests.courses.conftest import Class
from tests.courses.test_gradebook import as_tutor

CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Homework 0 (17)
    Points Possible,,,,,10
"Lovelace, Ada",7,s1,ada1,A,3
"Hopper, Grace",8,s2,grace2,A,
"""
MOODLE = """\
\ufeffFirst name,Last name,ID number,Email address,Course total
Ada,Lovelace,s1,ada@example.edu,3
Grace,Hopper,,grace@x.org,4
"""
# As Canvas exports it if an assignment has a posting policy, with the view of a student.
POSTED = """\
Student,ID,SIS User ID,SIS Login ID,Section,Homework 0 (17)
,,,,,Manual Posting
    Points Possible,,,,,10
"Lovelace, Ada",7,s1,ada1,A,3
"Student, Test",9,,7f3ad0,A,
"Student, Test",8,,,A,
"""
SEMICOLONS = "id;Name\r\n\r\n4711;Ada  Lovelace\r\n4712;Grace Hopper\r\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (CANVAS, [("ada1", "Lovelace, Ada", None), ("grace2", "Hopper, Grace", None)]),
        (
            MOODLE,
            [
                ("s1", "Ada Lovelace", "ada@example.edu"),
                (None, "Grace Hopper", "grace@x.org"),
            ],
        ),
        (POSTED, [("ada1", "Lovelace, Ada", None)]),
        ("Vorname,Nachname,E-Mail-Adresse\nAda,Müller,a@b.c\n", [(None, "Ada Müller", "a@b.c")]),
        ("Matrikelnummer;Name;Vorname\n47;Müller;Ada\n", [("47", "Ada Müller", None)]),
        ("Nombre;Apellido(s);Número de ID\nAda;Pérez;47\n", [("47", "Ada Pérez", None)]),
        ("Nombre,Correo\nAda Pérez,a@b.c\n", [(None, "Ada Pérez", "a@b.c")]),
        ("Prénom,Nom,Numéro d’identification\nAda,Brontë,47\n", [("47", "Ada Brontë", None)]),
        ("姓,名,学号\n王,小明,47\n", [("47", "王小明", None)]),
        (SEMICOLONS, [("4711", "Ada Lovelace", None), ("4712", "Grace Hopper", None)]),
        ("email\tname\na@b.c\tAda\n", [(None, "Ada", "a@b.c")]),
        ('name,email\n"Ada\nL",a@b.c\n', [(None, "Ada L", "a@b.c")]),
    ],
)
def test_class_lists_of_platforms_and_by_hand_are_read(
    text: str, expected: list[tuple[str | None, str, str | None]]
) -> None:
    found = [(each.learner, each.name, each.email) for each in read_class_list(text)]
    assert found == expected


def test_lists_with_two_columns_have_family_names() -> None:
    def families(text: str) -> list[str | None]:
        return [each.family_name for each in read_class_list(text)]

    assert families(MOODLE) == ["Lovelace", "Hopper"]
    assert families("Nombre;Apellidos;Email\nAda;García López;a@b.c\n") == ["García López"]
    # "Lovelace, Ada" begins with it.
    assert families(CANVAS) == [None, None]
    assert families(SEMICOLONS) == [None, None]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "empty"),
        ("name\nAda\n", "headings"),
        ("Ada Lovelace,ada@example.edu\n", "headings"),
        ("name,email\nAda,\n", "Line 2 .*no id and no e-mail"),
        ("name,email\nAda,ada\n", "Line 2 .*no usable email"),
        ("name,id\nAda,\u200b\n", "Line 2 .*no usable learner"),
        ("name,id\n,7\n", "Line 2 .*no usable name"),
        ("name,id\n" + "Ada,7\n" * 5002, "more than 5000"),
        ('name,id\n"' + "x" * 200_000 + '",7\n', "not CSV"),
    ],
)
def test_an_unusable_class_list_is_refused_with_the_line(text: str, reason: str) -> None:
    with pytest.raises(CourseError, match=reason):
        read_class_list(text)


def test_refusals_are_told_in_the_language_of_the_reader(class_: Class) -> None:
    path = "/v1/courses/robots/learners?lang=de"
    refused = as_tutor(class_).ask("POST", path, "tutor", csv="name,id\nAda,7\nBo,\n")
    assert refused.json()["detail"] == (
        "Zeile 3 der Kursliste hat keine id und keine E-Mail-Adresse."
    )
    path = "/v1/courses/robots/assignments?lang=de"
    twice = [{"exercise": "scara", "points": 1}] * 2
    refused = as_tutor(class_).ask("POST", path, "tutor", id="h", title="H", exercises=twice)
    assert refused.json()["detail"] == "Die Aufgabe scara kommt zweimal vor."


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-be", "cp1252"])
def test_encodings_of_spreadsheets_are_read(encoding: str) -> None:
    mark = codecs.BOM_UTF16_BE if encoding == "utf-16-be" else b""
    data = mark + "id;name\n1;Zoë Müller\n".encode(encoding)
    [found] = read_class_list(decoded(data))
    assert (found.learner, found.name) == ("1", "Zoë Müller")


def test_a_file_that_is_no_text_is_refused() -> None:
    for data in (b"\xff\xfea", b"PK\x03\x04\x81\x8d", b"\x00" * 9):
        with pytest.raises(CourseError):
            read_class_list(decoded(data))


# --- Names


def test_learners_of_one_name_are_told_apart() -> None:
    people = [
        CourseLearner(learner="u1", name="Alan Turing", email="alan@example.edu"),
        CourseLearner(learner="u2", name="Ada Lovelace", email="ada@example.edu"),
        CourseLearner(learner="u3", name="Alan Turing"),
    ]
    assert told_apart(people) == {
        "u1": "Alan Turing (alan@example.edu)",
        "u2": "Ada Lovelace",
        "u3": "Alan Turing (u3)",
    }


@dataclass
class Person:
    """A learner of a course, as in the database."""

    name: str
    family_name: str | None = None
    learner: str = "u1"


def test_learners_are_sorted_by_family_name_else_by_name() -> None:
    in_order = [
        Person("Élodie Adam", "Adam"),
        Person("Zoë Amsel", "Amsel"),
        Person("amsel, anna"),
        Person("Ångström, Zoë"),
        Person("Ada de la Cruz", "de la Cruz"),
        Person("Grace Hopper", "Hopper", "u1"),
        Person("Grace Hopper", "Hopper", "u2"),
        Person("Ada Żuk", "Żuk"),
    ]
    backwards = in_order[::-1]
    assert sorted(backwards, key=place_of) == in_order
