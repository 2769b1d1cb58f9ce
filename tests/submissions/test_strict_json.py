import contextlib
import json

import pytest
from dh_grader.submissions.bodies import (
    MAX_BRACKETS,
    MAX_COMMAS,
    MAX_DEPTH,
    MalformedError,
    nested_deeper,
    read_json,
)
from dh_grader.translations import LANGUAGES, told
from hypothesis import given
from hypothesis import strategies as st

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
    # Surrogates have their own test.
    | st.text(st.characters(codec="utf-8")),
    lambda inner: st.lists(inner) | st.dictionaries(
        st.text(st.characters(codec="utf-8")), inner
    ),
    max_leaves=20,
)  # fmt: skip


@given(JSON, st.booleans())
def test_what_json_writes_is_read_back(value: object, ascii_only: bool) -> None:
    assert read_json(json.dumps(value, ensure_ascii=ascii_only).encode()) == value


@given(st.binary())
def test_any_bytes_raise_only_malformed_error(data: bytes) -> None:
    with contextlib.suppress(MalformedError):
        read_json(data)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("NaN", "NaN"),
        ("-Infinity", "-Infinity"),
        ("1e999", "1e999"),
        ("9" * 309, "9" * 309),
        ("9" * 308, int("9" * 308)),
        ('"\\ud800"', "\ufffd"),
        ('{"\\udfff": ["a\\ud800b"]}', {"\ufffd": ["a\ufffdb"]}),
        ('"\\ud83d\\ude00"', "😀"),
        ('"\\\\ud800"', "\\ud800"),
    ],
)
def test_unrepresentable_numbers_and_surrogates_become_text(text: str, value: object) -> None:
    assert read_json(text.encode()) == value


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "nothing here"),
        ('{"a": 1, "b": {"c": 1, "c": 2}}', 'key "c" appears twice'),
        ('{"a": 1,}', "line 1, column "),
        ("[1,\n 2,\n x]", "line 3, column 2"),
        ('"\\x"', "line 1, column "),
        ('"\\u12"', "line 1, column "),
        ('"\n"', "line 1, column "),
        ('"a', "line 1, column "),
        ("[1 2]", "line 1, column "),
        ('{"a" 1}', "line 1, column "),
        ("1 2", "line 1, column "),
        ("[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1), "deep"),
        ("[" * MAX_BRACKETS + "]" * MAX_BRACKETS, "deep"),
        ("[" * 100_000 + "]" * 100_000, "lists and objects"),
        ("[" + "[]," * MAX_BRACKETS + "[]]", "lists and objects"),
    ],
)
def test_an_error_is_reported_with_its_place(text: str, reason: str) -> None:
    with pytest.raises(MalformedError) as caught:
        read_json(text.encode())
    assert reason in str(caught.value)
    # Every sentence of Python's own reader has a translation, too.
    german = LANGUAGES["de"].translation
    assert told(caught.value.reason, german) != caught.value.reason
    assert told(str(caught.value), german) != str(caught.value)


def test_the_depth_is_counted_exactly() -> None:
    deepest = "[" * MAX_DEPTH + "]" * MAX_DEPTH
    assert read_json(deepest.encode()) is not None
    assert not nested_deeper({"a": [{}]}, 3)
    assert nested_deeper({"a": [{}]}, 2)
    assert nested_deeper([1], 0)
    assert not nested_deeper("text", 0)


def test_brackets_in_strings_are_not_counted_as_nesting() -> None:
    assert read_json(json.dumps(["[" * 1000]).encode()) == ["[" * 1000]


def test_too_many_values_are_refused() -> None:
    # Without the limit, the program would read, check and hash each of 120,000 numbers.
    assert read_json(b"[" + b"1," * MAX_COMMAS + b"1]") == [1] * (MAX_COMMAS + 1)
    with pytest.raises(MalformedError, match="more than 20000 commas"):
        read_json(b"[" + b"1," * (MAX_COMMAS + 1) + b"1]")
