"""Convert the schemas of the OpenAPI document to a form that suits client generators.

A generated client needs a name for each model, and must know which fields may be absent.
"""

import json
from typing import Any, Final

Schema = dict[str, Any]

_REFERENCE: Final = "#/components/schemas/"
_NULL: Final = {"type": "null"}
# The mark of a field that answers recorded by an older version do not have.
ADDED_LATER: Final = "x-added-later"

# The names that classes have in the document if they are not their own.
_PUBLIC_NAMES: Final = {
    "Alive": "Liveness",
    "ComponentView": "ListComponent",
    "ExerciseView": "Exercise",
    "FramesAnswer": "Frames",
    "LinkSolution": "LinkTransform",
    "PartAnswer": "PartSolution",
    "PartView": "Part",
    "PreviewAnswer": "Preview",
    "ProblemDocument": "Problem",
    "Ready": "Readiness",
    "Reason": "ProblemReason",
    "Shown": "PrintedMatrix",
    "SymbolView": "ExerciseSymbol",
}
# The names of choices. The models have them as literals, without a name.
_CHOICES: Final = {
    ("angle", "length", "number"): "Quantity",
    ("R", "P"): "JointKind",
    ("auto", "light", "dark"): "Theme",
    ("content", "cells", "rows", "whole"): "Marking",
    ("full", "hints", "verdicts", "score"): "FeedbackLevel",
    ("given", "free"): "FrameFreedom",
    ("moving", "fixed"): "RotationAxes",
    ("radians", "degrees"): "AngleUnit",
    ("space", "body"): "ScrewFrame",
    ("unread", "zero"): "EmptyCells",
    ("open", "after", "none"): "Practice",
    ("never", "after_full", "after_due"): "ShowSolution",
    ("not_open", "open", "late", "closed"): "AssignmentState",
    ("json", "csv", "moodle", "canvas", "xlsx"): "GradebookFormat",
    ("waiting", "sent", "refused"): "ScoreState",
}


def public_name(name: str) -> str:
    """Return the name that a class has in the OpenAPI document."""
    return _PUBLIC_NAMES.get(name, name)


def tidy_schemas(document: Schema) -> None:
    """Give each model and enumeration a named schema, and sort the schemas by name."""
    components = document.setdefault("components", {})
    tidying = _Tidying()
    operations = [each for path in document["paths"].values() for each in path.values()]
    # A schema of requests and responses has the form of requests.
    for operation in operations:
        tidying.visit_request(operation)
    for name, schema in components.get("schemas", {}).items():
        tidying.name(name, schema)
    for operation in operations:
        tidying.visit_responses(operation)
    components["schemas"] = dict(sorted(tidying.named.items()))


class _Tidying:
    def __init__(self) -> None:
        self.named: Schema = {}

    def visit_request(self, operation: Schema) -> None:
        for parameter in operation.get("parameters", ()):
            parameter["schema"] = self.tidied(parameter["schema"])
        for content in operation.get("requestBody", {}).get("content", {}).values():
            content["schema"] = self.tidied(content["schema"], is_sent=False)

    def visit_responses(self, operation: Schema) -> None:
        for message in operation["responses"].values():
            for content in message.get("content", {}).values():
                content["schema"] = self.tidied(content["schema"])

    def name(self, name: str, schema: Schema, *, is_sent: bool = True) -> Schema:
        name = public_name(name)
        if name not in self.named:
            self.named[name] = {}
            self.named[name] = self._body(schema, is_sent=is_sent)
        return {"$ref": f"{_REFERENCE}{name}"}

    def tidied(self, schema: Schema, *, is_sent: bool = True) -> Schema:
        for name, definition in schema.get("$defs", {}).items():
            self.name(name, definition, is_sent=is_sent)
        if "properties" in schema:
            return self.name(schema["title"], schema, is_sent=is_sent)
        if "enum" in schema:
            choice = {"type": schema["type"], "enum": schema["enum"]}
            reference = self.name(_CHOICES[tuple(schema["enum"])], choice)
            return {**reference, **_texts(schema)}
        return self._body(schema, is_sent=is_sent)

    def _body(self, schema: Schema, *, is_sent: bool) -> Schema:
        body = {
            key: value
            for key, value in schema.items()
            if key not in ("$defs", "title", "default", "description", "properties")
        } | _texts(schema)
        if "$ref" in body:
            body["$ref"] = _REFERENCE + public_name(body["$ref"].removeprefix(_REFERENCE))
        for key in ("anyOf", "oneOf", "prefixItems"):
            if key in body:
                body[key] = [self.tidied(each, is_sent=is_sent) for each in body[key]]
        for key in ("items", "additionalProperties"):
            if isinstance(body.get(key), dict):
                body[key] = self.tidied(body[key], is_sent=is_sent)
        if mapping := body.get("discriminator", {}).get("mapping"):
            renamed = {
                value: _REFERENCE + public_name(reference.removeprefix(_REFERENCE))
                for value, reference in mapping.items()
            }
            body["discriminator"] = {**body["discriminator"], "mapping": renamed}
        if "properties" in schema:
            body |= self._fields(schema, is_sent=is_sent)
        return body

    def _fields(self, schema: Schema, *, is_sent: bool) -> Schema:
        # In responses, a field with a default is required, because the service always sends the
        # field. A field with the mark ADDED_LATER is not, because a response that an older version
        # has recorded may lack the field. In requests, a default is written into the description:
        # "default" makes some generators require the field.
        required = list(schema.get("required", ()))
        fields = {}
        for name, field in schema["properties"].items():
            if name not in required:
                field = _without_null(field) if is_sent else _without_null_default(field)
                added_later = field.pop(ADDED_LATER, False)
                if "default" in field:
                    default = json.dumps(field.pop("default"))
                    if is_sent and not added_later:
                        required.append(name)
                    elif not is_sent:
                        field["description"] += f" Default: `{default}`."
            fields[name] = self.tidied(field, is_sent=is_sent)
        in_order = [name for name in fields if name in required]
        return {"properties": fields} | ({"required": in_order} if in_order else {})


def _without_null(field: Schema) -> Schema:
    # The service leaves the field out instead of sending null.
    forms = [form for form in field.get("anyOf", ()) if form != _NULL]
    rest = {key: value for key, value in _without_null_default(field).items() if key != "anyOf"}
    if len(forms) == 1:
        return {**forms[0], **rest}
    return {**rest, "anyOf": forms} if forms else rest


def _without_null_default(field: Schema) -> Schema:
    # In requests, such a field may also be null.
    is_none = field.get("default", ()) is None
    return {key: value for key, value in field.items() if key != "default" or not is_none}


def _texts(schema: Schema) -> Schema:
    if "description" not in schema:
        return {}
    return {"description": schema["description"].replace("``", "`")}
