import re

import pytest
from dh_grader.formats.class_page import LONGEST, distinct_file_names, file_stem


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("Anna Müller", "Anna-Müller"),
        ("李明", "李明"),
        ("s1234567_late", "s1234567_late"),
        ("../../etc/passwd", "etc-passwd"),
        ("C:\\Windows\\x", "C-Windows-x"),
        (".hidden", "hidden"),
        ("a\0b\n\x1b[31mc", "a-b-31mc"),
        ("\u202egpj.exe", "gpj-exe"),
        ('x" onmouseover="y', "x-onmouseover-y"),
        ("-rf", "rf"),
        ("", "submission"),
        ("..", "submission"),
        ("\udc80", "submission"),
        ("nul", "nul-"),
        ("COM1", "COM1-"),
        ("e\u0301va", "éva"),
    ],
)
def test_only_letters_and_digits_are_kept(name: str, stem: str) -> None:
    assert file_stem(name) == stem


def test_a_name_is_short_enough_for_any_system() -> None:
    names = ["𝔞" * 300, "é" * 300, "x" * 300]
    distinct = distinct_file_names(".html")
    for name in names * 3:
        file = distinct(name)
        assert len(file) < LONGEST + 10
        assert len(file.encode()) < 255


def test_names_are_distinct_on_any_system() -> None:
    distinct = distinct_file_names(".html")
    files = [
        distinct(name) for name in ("Anna", "anna", "ANNA", "anna-2", "éa", "e\u0301a", "ﬁ", "fi")
    ]
    assert files == [
        "Anna.html", "anna-2.html", "ANNA-3.html", "anna-2-2.html",
        "éa.html", "éa-2.html", "ﬁ.html", "fi-2.html",
    ]  # fmt: skip
    assert all(re.fullmatch(r"[\w-]+\.html", file) for file in files)
