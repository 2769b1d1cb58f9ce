import pytest

from service.courses.class_list import read_class_list
from service.courses.errors import CourseError

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
        (SEMICOLONS, [("4711", "Ada Lovelace", None), ("4712", "Grace Hopper", None)]),
        ("email\tname\na@b.c\tAda\n", [(None, "Ada", "a@b.c")]),
        ('name,email\n"Ada\nL",a@b.c\n', [(None, "Ada L", "a@b.c")]),
    ],
)
def test_a_class_list_of_a_platform_or_by_hand(
    text: str, expected: list[tuple[str | None, str, str | None]]
) -> None:
    found = [(each.learner, each.name, each.email) for each in read_class_list(text)]
    assert found == expected


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
