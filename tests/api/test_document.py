"""The OpenAPI document is correct, and linters and client generators accept it."""

import copy
import json
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, get_args
from urllib.parse import quote

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.document import _BODY_SCHEMAS, EXAMPLES, public_name
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from fastapi import FastAPI
from jsonschema import Draft202012Validator
from openapi_spec_validator import validate
from pydantic import BaseModel, StringConstraints, TypeAdapter

from tests.front.deno import deno

Schema = dict[str, Any]

EXAMPLE_URLS = {
    "grade": "/v1/exercises/stanford-arm/grade",
    "grade-many": "/v1/grade",
    "frames": "/v1/frames",
    "preview": "/v1/preview",
    "preview-many": "/v1/previews",
}
ROUTES = {**EXAMPLE_URLS, "grade": "/v1/exercises/{exercise_id}/grade"}
PROBLEM = {"$ref": "#/components/schemas/Problem"}
# Written out, because they are names of functions in programs of other people.
OPERATIONS = {
    "listExercises", "getExercise", "getFigure", "getFrames", "getFrameChoices", "getHint",
    "takeHint", "getSolutionForRightAnswers",
    "getRulePicture", "getSolution", "grade",
    "gradeMany", "createToken", "recordAttempt", "listAttempts", "getAttempt", "getStatistics",
    "preview", "previewMany", "getLiveness", "getReadiness", "exportAttempts", "overrideAttempt",
    "forgetLearner", "regradeAttempts", "getNextRobot", "listCourses", "createCourse",
    "getCourse", "changeCourse",
    "listLearners", "addLearners", "getLearnerView", "createLinks", "revokeLinks", "getGradebook",
    "listScores", "sendScores",
    "listAssignments", "createAssignment", "getAssignment", "changeAssignment",
    "extendAssignment", "deleteAssignment", "deleteCourse", "removeLearner",
    "listMissing", "handIn", "getAssignedSolution", "getOwnView", "listVariants", "dealVariant",
}  # fmt: skip
NAMES = {
    "Exercise", "ExerciseList", "Part", "GradeRequest", "GradeManyRequest", "GradeManyResponse",
    "GradeResult", "Report", "PartReport", "RowReport", "CellReport", "Feedback", "Correction",
    "Place", "Verdict", "Severity", "FeedbackLevel", "AngleUnit", "Preview", "PreviewRequest",
    "Problem", "ProblemReason", "ModelSolution", "DhTableShape", "MatrixShape", "ListShape",
}  # fmt: skip


@pytest.fixture(scope="module")
def document(client: httpx.Client) -> Schema:
    result: Schema = client.get("/openapi.json").json()
    return result


def operations(document: Schema) -> list[Schema]:
    return [operation for path in document["paths"].values() for operation in path.values()]


def schemas_in(value: Any) -> Iterator[Schema]:
    if isinstance(value, dict):
        if not value.keys().isdisjoint({"type", "$ref", "anyOf", "oneOf", "const"}):
            yield value
        for name, each in value.items():
            if name == "properties":
                for field in each.values():
                    yield from schemas_in(field)
            elif name not in ("example", "examples"):
                yield from schemas_in(each)
    elif isinstance(value, list):
        for each in value:
            yield from schemas_in(each)


# --- true


def without_versions(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: without_versions(each) for name, each in value.items() if name != "version"}
    return [without_versions(each) for each in value] if isinstance(value, list) else value


@pytest.mark.parametrize("name", EXAMPLE_URLS)
def test_the_documented_answer_is_what_the_service_answers(
    client: httpx.Client, document: Schema, name: str
) -> None:
    operation = document["paths"][ROUTES[name]]["post"]
    request = operation["requestBody"]["content"]["application/json"]["example"]
    documented = operation["responses"]["200"]["content"]["application/json"]["example"]
    answered = client.post(EXAMPLE_URLS[name], json=request).json()
    # A version is a digest of the exercise's file, so it changes with every statement.
    assert without_versions(documented) == without_versions(answered), (
        f"The answer has changed; {EXAMPLES / name}-response.json should now be:\n"
        + json.dumps(answered, indent=2, ensure_ascii=False)
    )


@pytest.mark.long
def test_it_is_valid_openapi(document: Schema) -> None:
    validate(document)


def test_the_examples_fit_their_schemas(document: Schema) -> None:
    count = 0
    for operation in operations(document):
        messages = [operation.get("requestBody", {}), *operation["responses"].values()]
        for content in [each for one in messages for each in one.get("content", {}).values()]:
            if "example" in content:
                strictly(document, content["schema"]).validate(content["example"])
                count += 1
    assert count == 21


def strictly(document: Schema, schema: Schema) -> Draft202012Validator:
    components = copy.deepcopy(document["components"])
    for each in components["schemas"].values():
        # Some schemas, such as LinkTransform, repeat the fields of their base class.
        if "properties" in each:
            each["additionalProperties"] = False
    return Draft202012Validator({**schema, "components": components})


WRONG_TABLE = {"rows": [["a1", "0", "0", "-q1"], ["a2", "90", "0", "q2 +"]]}
ANSWERED = [
    ("GET", "/v1/exercises", {}, "/v1/exercises"),
    ("GET", "/healthz", {}, "/healthz"),
    ("GET", "/readyz", {}, "/readyz"),
    (
        "POST",
        "/v1/exercises/planar-rr/grade",
        {"answers": {"table": WRONG_TABLE, "position": ["a1 c1", "1.234"]}, "echo": True},
        "/v1/exercises/{exercise_id}/grade",
    ),
    ("POST", "/v1/exercises/planar/grade", {"answers": {}}, "/v1/exercises/{exercise_id}/grade"),
    ("POST", "/v1/exercises/planar-rr/grade", {}, "/v1/exercises/{exercise_id}/grade"),
    ("POST", "/v1/grade", {"submissions": [{}, {"exercise": "planar-rr", "answers": {}}]}, None),
    ("POST", "/v1/grade", [], None),
    ("POST", "/v1/preview", {"text": "sin q1/2"}, None),
    ("POST", "/v1/preview", {"text": "theta 1 +"}, None),
    (
        "POST",
        "/v1/previews",
        {"exercise": "scara", "part": "table", "entries": [{"text": "q1*"}, {"text": "2 +"}]},
        None,
    ),
    (
        "POST",
        "/v1/preview",
        {"text": "a1 0 0 q1\na2 0 0 q2+", "exercise": "planar-rr", "part": "table"},
        None,
    ),
]


@pytest.mark.parametrize(("method", "url", "body", "route"), ANSWERED)
def test_what_the_service_answers_is_documented_field_by_field(
    client: httpx.Client, document: Schema, method: str, url: str, body: object, route: str | None
) -> None:
    answer = client.request(method, url, json=body or None if method == "GET" else body)
    responses = document["paths"][route or url][method.lower()]["responses"]
    content = responses[str(answer.status_code)]["content"]
    strictly(document, content[answer.headers["content-type"]]["schema"]).validate(answer.json())


@pytest.mark.long
def test_every_exercise_and_its_solution_are_documented_field_by_field(
    client: httpx.Client, document: Schema, catalogue: Mapping[str, Exercise],
    client_of: Callable[[FastAPI], httpx.Client],
) -> None:  # fmt: skip
    shown, solved = (
        strictly(document, {"$ref": f"#/components/schemas/{name}"})
        for name in ("Exercise", "ModelSolution")
    )
    for exercise in catalogue:
        shown.validate(client.get(f"/v1/exercises/{exercise}").json())
    with client_of(application(catalogue, access=Access(solutions=True))) as tutor:
        solved.validate(tutor.get("/v1/exercises/planar-rr/solution").json())


# --- as linters want it


def test_the_heading(document: Schema) -> None:
    assert document["info"]["license"] == {"name": "MIT", "identifier": "MIT"}
    assert document["info"]["contact"]["name"]
    assert document["info"]["summary"]
    assert document["info"]["description"]
    [server] = document["servers"]
    assert server["url"] == "."
    assert document["security"] == []


def test_each_operation_has_one_described_tag_and_each_tag_an_operation(document: Schema) -> None:
    described = [tag["name"] for tag in document["tags"] if tag["description"]]
    tags = [operation["tags"] for operation in operations(document)]
    assert [len(each) for each in tags] == [1] * len(tags)
    assert sorted(described) == sorted({tag for [tag] in tags})


def test_every_operation_is_named_and_described(document: Schema) -> None:
    found = operations(document)
    assert sorted(each["operationId"] for each in found) == sorted(OPERATIONS)
    assert all(each["summary"] and each["description"] for each in found)
    for each in found:
        [success] = [status for status in each["responses"] if status.startswith("20")]
        assert each["responses"][success]["description"] != "Successful Response"
    assert all(name["description"] for each in found for name in each.get("parameters", ()))


def test_every_refusal_is_documented_as_a_problem(document: Schema) -> None:
    for operation in operations(document):
        refused = {k: v for k, v in operation["responses"].items() if k[:2] != "20"}
        assert {"4XX", "5XX"} <= refused.keys()
        for response in refused.values():
            assert response["content"] == {"application/problem+json": {"schema": PROBLEM}}


# --- as generators of clients want it


def test_the_names_of_the_schemas(document: Schema) -> None:
    names = set(document["components"]["schemas"])
    assert names >= NAMES
    assert [name for name in names if not re.fullmatch(r"([A-Z][a-z]+)+", name)] == []
    assert [name for name in names if name.endswith(("View", "Document", "Input", "Output"))] == []


def test_every_reference_leads_somewhere_and_every_schema_is_used(document: Schema) -> None:
    found = {each["$ref"] for each in schemas_in(document) if "$ref" in each}
    found |= {
        reference
        for each in schemas_in(document)
        for reference in each.get("discriminator", {}).get("mapping", {}).values()
    }
    assert found == {f"#/components/schemas/{name}" for name in document["components"]["schemas"]}


def test_models_and_choices_are_never_written_out_in_place(document: Schema) -> None:
    named = document["components"]["schemas"].values()
    inside = [
        each
        for each in schemas_in(document)
        if ("enum" in each or "properties" in each) and not any(each is one for one in named)
    ]
    assert inside == []


def test_a_field_may_be_null_where_the_service_takes_or_sends_null(document: Schema) -> None:
    nullable = {
        (name, field)
        for name, schema in document["components"]["schemas"].items()
        for field, each in schema.get("properties", {}).items()
        if "null" in json.dumps(each)
    }
    # The models by which the program reads bodies.
    taken, read = set(), set(_BODY_SCHEMAS)
    while read:
        model = read.pop()
        for name, field in model.model_fields.items():
            within = _within(field.annotation)
            read |= {each for each in within if isinstance(each, type(BaseModel))}
            if type(None) in within:
                taken.add((public_name(model.__name__), name))
    assert nullable == taken | {("ExerciseSummary", "structure"), ("GradebookRow", "points")}


def _within(annotation: Any) -> list[Any]:
    found = [annotation]
    for each in get_args(annotation):
        found += _within(each)
    return found


def test_there_are_no_titles_and_no_defaults(document: Schema) -> None:
    # A title repeats a name, and a default makes openapi-typescript require the field.
    assert [each for each in schemas_in(document) if {"title", "default"} & each.keys()] == []


def test_different_shapes_are_told_apart_by_their_form(document: Schema) -> None:
    schemas = document["components"]["schemas"]
    shape = schemas["Part"]["properties"]["shape"]
    assert shape["discriminator"]["propertyName"] == "form"
    mapping = shape["discriminator"]["mapping"]
    assert {each["$ref"] for each in shape["oneOf"]} == set(mapping.values())
    for form, reference in mapping.items():
        variant = schemas[reference.rpartition("/")[2]]
        assert variant["properties"]["form"]["const"] == form
        assert "form" in variant["required"]


def test_the_request_is_described_field_by_field(document: Schema) -> None:
    operation = document["paths"][ROUTES["grade"]]["post"]
    assert operation["requestBody"]["content"]["application/json"]["schema"] == {
        "$ref": "#/components/schemas/GradeRequest"
    }
    schema = document["components"]["schemas"]["GradeRequest"]
    assert schema["required"] == ["answers"]
    assert set(schema["properties"]) == {"answers", "angle_unit", "feedback", "echo"}
    assert all(field["description"] for field in schema["properties"].values())
    assert schema["properties"]["angle_unit"]["description"].endswith(' Default: `"radians"`.')
    many = document["components"]["schemas"]["GradeManyRequest"]["properties"]["submissions"]
    assert many["items"] == {"$ref": "#/components/schemas/ExerciseSubmission"}
    assert many["maxItems"] == 64


def test_a_report_always_has_its_lists(document: Schema) -> None:
    row = document["components"]["schemas"]["RowReport"]
    assert row["required"] == ["label", "verdict", "points", "max_points", "cells", "feedback"]
    assert "read" not in document["components"]["schemas"]["CellReport"]["required"]


def test_reports_of_older_versions_have_no_lost_points(document: Schema) -> None:
    part = document["components"]["schemas"]["PartReport"]
    assert part["properties"].keys() - set(part["required"]) == {"lost", "little_worth"}
    assert part["properties"]["lost"].keys() == {"type", "items"}


def parameters(document: Schema) -> Iterator[tuple[str, str, Schema, Schema]]:
    """Yield the method and path of each operation with each of its parameters and its form."""
    for path, operations_there in document["paths"].items():
        for method, operation in operations_there.items():
            for each in operation.get("parameters", ()):
                schema = each["schema"]
                forms = schema.get("anyOf", [schema])
                [form] = [one for one in forms if one != {"type": "null"}]
                if "$ref" in form:
                    form = document["components"]["schemas"][form["$ref"].rpartition("/")[2]]
                yield method, path, each, form


def test_every_parameter_has_a_bound(document: Schema) -> None:
    kinds = set()
    for method, path, parameter, form in parameters(document):
        place = f"{method} {path} {parameter['name']}"
        kinds.add(form["type"])
        match form["type"]:
            case "string":
                bounds = form.keys() & {"maxLength", "enum"}
                assert bounds or form.get("format") == "date-time", place
            case "integer":
                assert form.keys() >= {"minimum", "maximum"}, place
            case other:
                assert other == "boolean", place
    assert kinds == {"string", "integer", "boolean"}


@pytest.mark.long
def test_every_parameter_outside_of_its_bounds_is_refused(
    document: Schema,
    client_of: Callable[[FastAPI], httpx.Client],
    catalogue: Mapping[str, Exercise],
) -> None:
    access = Access()
    app = application(catalogue, access=access)
    # Everybody may do everything.
    app.dependency_overrides[access.permit] = lambda: None
    client, checked = client_of(app), 0
    for method, path, parameter, form in parameters(document):
        name = parameter["name"]
        wrong = ["x" * (form["maxLength"] + 1)] if "maxLength" in form else []
        if form["type"] == "integer":
            wrong += [str(form["minimum"] - 1), str(form["maximum"] + 1), "1.5", "1e0", "one"]
        if form["type"] == "boolean":
            wrong += ["2", "maybe"]
        if "enum" in form or form.get("format") == "date-time":
            wrong += ["0.5", "x" * 5000]
        if form.get("pattern", "").startswith("^[a-z0-9]"):
            wrong += ["0.5", "a b", "-", "A", ""]
        in_path = parameter["in"] == "path"
        for value in filter(None, wrong) if in_path else wrong:
            url = path.replace(f"{{{name}}}", quote(value)) if in_path else path
            url = re.sub(r"\{\w+\}", "theta", url.replace("{exercise_id}", "planar-rr"))
            query = {name: value} if parameter["in"] == "query" else {}
            headers = {name: value} if parameter["in"] == "header" else {}
            body: Schema = {"json": {}} if method == "post" else {}
            answer = client.request(method, url, params=query, headers=headers, **body)
            place = f"{method} {url[:80]} {name}={value[:40]}"
            assert answer.status_code == 422, (place, answer.text)
            pointers = [each["pointer"] for each in answer.json()["errors"]]
            assert f"#/{name}".lower() in map(str.lower, pointers), (place, answer.text)
            checked += 1
    assert checked > 150


# Texts that some of the patterns accept.
TEXTS = (
    "", "a", "A", "robotics-2026", "-a", "a-", "a--b", "Ada Lovelace", "Ada  Lovelace", " a", "a ",
    "ada@example.edu", "a@b@c", "a,b@c", "RPR", "RRRRRRRRRRRR", "rpr", "1", "\u03b81", "a\u200bb",
    "a\u00a0b", "a\nb", "a\n", "\x00", "a\x00", "\U0001f600", "\ufeff", "0.5",
)  # fmt: skip
SCRIPT = """
const [patterns, texts] = JSON.parse(new TextDecoder().decode(await new Response(
  Deno.stdin.readable).arrayBuffer()));
const told = patterns.map((pattern) => ["", "u", "v"].map((flag) => {
  const compiled = new RegExp(pattern, flag);
  return texts.map((text) => compiled.test(text));
}));
console.log(JSON.stringify(told));
"""


@pytest.mark.long
def test_javascript_reads_every_pattern_as_the_service_does(
    document: Schema, tmp_path: Path
) -> None:
    patterns = sorted({each["pattern"] for each in schemas_in(document) if "pattern" in each})
    assert len(patterns) >= 7
    (script := tmp_path / "patterns.js").write_text(SCRIPT, encoding="utf-8")
    given = json.dumps([patterns, TEXTS])
    found = deno("run", "--quiet", "--no-check", "--no-lock", str(script), written=given)
    assert found.returncode == 0, found.stdout
    for pattern, by_flag in zip(patterns, json.loads(found.stdout), strict=True):
        checked = TypeAdapter(Annotated[str, StringConstraints(pattern=pattern)]).validator
        expected = [checked.isinstance_python(text) for text in TEXTS]
        assert by_flag == [expected] * 3, pattern
        assert True in expected
        assert False in expected
