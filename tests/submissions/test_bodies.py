"""Test the bodies of requests: JSON, fields and their errors."""

import contextlib
import json
from collections.abc import Iterator, Mapping
from typing import Any, Final

import pytest
from dh_grader.api.application import application
from dh_grader.contract import AttemptRequest
from dh_grader.contract.courses import CourseChange, LinksRequest, NewAssignment
from dh_grader.contract.frames import FramesRequest
from dh_grader.submissions.bodies import (
    MAX_BRACKETS,
    MAX_COMMAS,
    MAX_DEPTH,
    GradeManyRequest,
    GradeRequest,
    MalformedError,
    UnknownExerciseError,
    field_error,
    find_exercise,
    nearest,
    nested_deeper,
    read_json,
)
from dh_grader.translations import LANGUAGES, say, told
from dh_grader.web.tutor_checks import ClassUpload
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from tests.shipped import shipped_exercises

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


# --- Lookup


def test_a_known_exercise_is_found() -> None:
    catalogue = shipped_exercises()
    assert find_exercise(catalogue, "scara") is catalogue["scara"]


@pytest.mark.parametrize(
    ("mistyped", "meant"),
    [("Scara", "scara"), ("stanford_arm", "stanford-arm"), ("rrr", "rrrp"), ("xyz", None)],
)
def test_an_unknown_exercise_gets_a_suggestion(mistyped: str, meant: str | None) -> None:
    with pytest.raises(UnknownExerciseError) as caught:
        find_exercise(shipped_exercises(), mistyped)
    assert caught.value.suggestion == meant
    assert (str(meant) in str(caught.value)) == (meant is not None)


def test_a_very_long_name_is_cut_before_comparison() -> None:
    assert nearest("a" * 10**7, ["scara"]) is None
    assert len(str(UnknownExerciseError("a" * 10**6, ("scara",)))) < 200


# --- Every error in a request body has a translated sentence

ROOMS: Final = (
    "dh_grader.contract",
    "dh_grader.submissions.bodies",
    "dh_grader.web",
    "dh_grader.lti",
)
HOSTILE: Final[tuple[Any, ...]] = (
    None, True, 7, 0.5, -1, 10**9, 10**5000, float("inf"), "", "a b", "É\0", "x" * 300, "7.5",
    "2026-10-01", "2026-99-01T25:00", [], {}, {"unknown": 1},
)  # fmt: skip


def errors_of(model: type[BaseModel], body: object) -> list[Any]:
    try:
        model.model_validate(body)
    except ValidationError as error:
        return error.errors(include_url=False, include_input=False)
    return []


def request_models() -> Iterator[type[BaseModel]]:
    """Yield the models of request bodies."""
    # Models of responses do not refuse unknown fields.
    assert application is not None
    waiting: list[type[BaseModel]] = [BaseModel]
    while waiting:
        below = waiting.pop().__subclasses__()
        waiting += below
        for each in below:
            if each.__module__.startswith(ROOMS) and each.model_config.get("extra") == "forbid":
                yield each


def wrong(schema: Mapping[str, Any], models: Mapping[str, Any]) -> Iterator[Any]:
    """Yield values that do not match a JSON schema."""
    yield from HOSTILE
    if "$ref" in schema:
        schema = models[schema["$ref"].rpartition("/")[2]]
    for each in schema.get("anyOf", ()):
        yield from wrong(each, models)
    if "items" in schema:
        yield [0] * (schema.get("maxItems", 0) + 1)
        yield from ([each] for each in wrong(schema["items"], models))
    if "maxProperties" in schema:
        yield {str(i): 0 for i in range(schema["maxProperties"] + 1)}
    for name, each in schema.get("properties", {}).items():
        yield from ({name: value} for value in wrong(each, models))


def test_every_error_of_a_body_has_a_sentence_of_ours() -> None:
    models = list(request_models())
    assert {GradeRequest, AttemptRequest, NewAssignment, FramesRequest, ClassUpload} <= set(models)
    kinds = set()
    for model in models:
        schema = model.model_json_schema()
        for body in wrong(schema, schema.get("$defs", {})):
            for detail in errors_of(model, body):
                kinds.add(detail["type"])
                message = field_error(detail)
                assert not message.startswith("This value cannot be used"), detail
                for code in LANGUAGES.keys() - {"en"}:
                    assert told(message, LANGUAGES[code].translation) != message
    # Were the bodies hostile enough?
    assert kinds >= {
        "bool_type", "dict_type",
        "extra_forbidden", "finite_number", "greater_than", "greater_than_equal", "int_from_float",
        "int_parsing", "less_than_equal", "list_type", "literal_error", "missing", "model_type",
        "string_pattern_mismatch", "string_too_long", "string_too_short", "string_type", "too_long",
        "too_short",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("model", "body", "code", "message"),
    [
        (GradeRequest, {}, "de", "Dieses Feld fehlt."),
        (GradeRequest, {"answers": []}, "fr", "Il faut ici un objet JSON."),
        (GradeRequest, {"answers": {}, "feedback": "x"}, "es",
         "Tiene que ser uno de estos valores: full, hints, verdicts, score."),
        (GradeManyRequest, {"submissions": [1] * 65}, "zh", "最多 64 项，这里有 65 项。"),
        (LinksRequest, {"days": 0}, "fr", "La valeur doit être au moins 1."),
        (CourseChange, {"title": ""}, "de", "Mindestens 1 Zeichen ist nötig."),
        (AttemptRequest, {"answers": {}, "learner": "a\nb"}, "es",
         "Escribe una sola línea de caracteres visibles, con un espacio entre palabras."),
    ],
)  # fmt: skip
def test_an_error_is_told_with_its_values(
    model: type[BaseModel], body: object, code: str, message: str
) -> None:
    [detail] = errors_of(model, body)
    assert told(field_error(detail), LANGUAGES[code].translation) == message


def test_an_unknown_field_is_told_with_the_known_ones() -> None:
    detail = {"type": "extra_forbidden", "loc": ("angle",), "msg": ""}
    message = "This field is not known; the fields are answers, echo."
    assert field_error(detail, ["answers", "echo"]) == message


def test_an_error_of_our_own_keeps_its_sentence() -> None:
    sentence = say("Choose at least one exercise.")
    assert field_error({"type": "either", "loc": (), "msg": sentence}) is sentence
    raised = {"type": "value_error", "loc": (), "msg": "", "ctx": {"error": ValueError(sentence)}}
    assert field_error(raised) is sentence


def test_any_other_error_quotes_its_english_text() -> None:
    detail = {"type": "date_future", "loc": (), "msg": "Date should be in the future"}
    german = told(field_error(detail), LANGUAGES["de"].translation)
    assert german == "Dieser Wert ist nicht verwendbar (Date should be in the future)."
