"""Every error in a request body has a translated sentence."""

from collections.abc import Iterator, Mapping
from typing import Any, Final

import pytest
from dh_grader.api.application import application
from dh_grader.contract import AttemptRequest
from dh_grader.contract.courses import CourseChange, LinksRequest, NewAssignment
from dh_grader.contract.frames import FramesRequest
from dh_grader.submissions.bodies import GradeManyRequest, GradeRequest, field_error
from dh_grader.translations import LANGUAGES, say, told
from dh_grader.web.tutor_checks import ClassUpload
from pydantic import BaseModel, ValidationError

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
