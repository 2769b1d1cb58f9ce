"""Write docs/exercise-fields.md, the page on the keys of an exercise file.

Run ``python -m tests.docs.exercise_fields > docs/exercise-fields.md``.
"""

import ast
import inspect
import json
import re
import sys
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any, Final

from dh_grader.catalogue.files import table_in
from dh_grader.catalogue.kinds import SPECS
from dh_grader.catalogue.part import PartSpec, PosePartSpec
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    PartTextsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    TranslationSpec,
    ViewSpec,
)
from dh_grader.catalogue.schema_fields import AttemptsSpec
from pydantic import BaseModel
from pydantic.fields import FieldInfo

Schema = Mapping[str, Any]

# An example of a value in TOML, by model and attribute, unless the type is clear without one.
_EXAMPLES: Final = {
    "ExerciseSpec.title": '"Elbow arm"',
    "ExerciseSpec.source": '"Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, 3.2"',
    "RobotSpec.table": '[["l1", "0", "0", "theta1"], ["l2", "180deg", "d2", "0"]]',
    "RobotSpec.structure": '"RP"',
    "RobotSpec.joints": '["theta1", "d2"]',
    "ScrewRobotSpec.screws": '[["0", "0", "1", "0", "0", "0"], ["0", "0", "0", "1", "0", "0"]]',
    "ScrewRobotSpec.structure": '"RP"',
    "ScrewRobotSpec.joints": '["theta1", "d2"]',
    "SymbolSpec.description": '"length of link 1"',
    "SymbolSpec.unit": '"m"',
    "SymbolSpec.range": "[0.3, 0.9]",
    "PartSpec.title": '"Denavit-Hartenberg table"',
    "PartSpec.prompt": '"Give the standard DH table, one row for each joint."',
    "PartSpec.points": "12",
    "PartSpec.follows": '"table"',
    "PartSpec.follows_from": "0.75",
    "PartSpec.id": '"table"',
    "PosePartSpec.start": "2",
    "PosePartSpec.to": "3",
    "AttemptsSpec.limit": "3",
    "AttemptsSpec.due": "2026-12-18T23:59:59+01:00",
    "AttemptsSpec.closes": "2026-12-20T23:59:59+01:00",
    "ExpectSpec.points": "5.5",
    "ExpectSpec.codes": '["sign"]',
    "ExpectSpec.follow_through": "true",
    "TranslationSpec.title": '"Knickarm"',
    "TranslationSpec.symbols": '{ l1 = "Länge von Glied 1" }',
    "PartTextsSpec.title": '"Denavit-Hartenberg-Tabelle"',
    "CheckSpec.title": '"x1 the other way round, in degrees"',
    "EulerAnglesSpec.expected": '["phi", "theta", "psi"]',
    "ComponentSpec.name": '"p_x"',
    "ComponentSpec.expected": '"l1*c1 + l2*c12"',
    "VectorSpec.components": '[{ name = "phi", quantity = "angle", expected = "theta1 + theta2" }]',
    "StepSpec.angle": '"theta1"',
    "RotationSpec.steps": '[{ axis = "x", angle = "phi" }, { axis = "z", angle = "psi" }]',
    "MatrixSpec.expected": '[["0", "-omega3"], ["omega3", "0"]]',
    "MatrixSpec.quantity": '["number", "length"]',
    "PositionSpec.coordinates": '"xy"',
    "PositionSpec.expected": '["l1 + l2", "0", "d1"]',
    "ScrewAxesSpec.expected": '[["0", "0", "1", "0", "-l1", "0"]]',
}
_KINDS: Final = ", ".join(f"`{kind}`" for kind in SPECS)
_INTRODUCTION: Final = """\
# The keys of an exercise file

This page lists every key of an exercise file, in the usual order. [Write an
exercise](write-an-exercise.md) explains a whole file, and [Answer kinds](answer-kinds.md)
shows what students hand in.

A *formula* is text in the students' notation, such as `"l1 + 0.1"` or `"-90deg"`, or a number. An
angle without a unit is in radians. A key that is not listed here is an error, and so is a value of
another type. A text has at most 20,000 characters, and no invisible control characters.

This page is generated: `python -m tests.docs.exercise_fields`."""
_PARTS: Final = f"""\
Every part has these keys and the key `kind`; the further keys of each kind follow below. The kinds
are {_KINDS}."""
_POSES: Final = """\
Parts of these kinds ask for a pose of the robot, or for a property of it. Leave these keys out if
the part gives the answer itself."""


def page() -> str:
    """Return the whole page, in Markdown."""
    poses = [kind for kind, spec in SPECS.items() if issubclass(spec, PosePartSpec)]
    sections = [
        _INTRODUCTION,
        _section("## The file", ExerciseSpec),
        _section("## `[robot]` with a table", RobotSpec),
        _section("## `[robot]` with screw axes", ScrewRobotSpec),
        _section("## `[symbols]`", SymbolSpec),
        _section("## `[attempts]`", AttemptsSpec),
        _section("## `[view]`", ViewSpec),
        _section("## `[[parts]]`", PartSpec, _PARTS),
        _section(f"### {', '.join(f'`{kind}`' for kind in poses)}", PosePartSpec, _POSES),
    ]
    for kind, spec in SPECS.items():
        sections.append(_section(f"### `{kind}`", spec, first=f'kind = "{kind}"'))
        for name, field in spec.model_fields.items():
            table = table_in(field.annotation)
            if table is not None:
                sections.append(_section(f"#### `{name}` of `{kind}`", table))
    sections += [
        _section("## `[[checks]]`", CheckSpec),
        _section("## `expect.PART` of `[[checks]]`", ExpectSpec),
        _section("## `[translations.de]`", TranslationSpec),
        _section("## `[translations.de.parts.PART]`", PartTextsSpec),
    ]
    return "\n\n".join(sections) + "\n"


def _section(heading: str, model: type[BaseModel], text: str = "", first: str = "") -> str:
    schema = model.model_json_schema()
    base = model.__base__
    known = set(base.model_fields) if base and issubclass(base, BaseModel) else set[str]()
    if first:
        known.add("kind")
    fields = {
        field.alias or name: field
        for name, field in model.model_fields.items()
        if name not in known
    }
    blocks = [heading, text or _markdown(inspect.getdoc(model) or "")]
    if fields:
        blocks.append("\n".join(_rows(fields, schema, meanings(model))))
    examples = [
        f"{field.alias or name} = {_EXAMPLES[f'{model.__name__}.{name}']}"
        for name, field in model.model_fields.items()
        if f"{model.__name__}.{name}" in _EXAMPLES
    ]
    if first or examples:
        blocks.append("\n".join(["```toml", *filter(None, [first]), *examples, "```"]))
    return "\n\n".join(blocks)


def meanings(model: type[BaseModel]) -> dict[str, str]:
    """Return the description of each field of a model."""
    [tree] = ast.parse(textwrap.dedent(inspect.getsource(model))).body
    assert isinstance(tree, ast.ClassDef)
    found = {}
    for field, text in pairwise(tree.body):
        match field, text:
            case ast.AnnAssign(target=ast.Name(name)), ast.Expr(ast.Constant(str(meaning))):
                found[model.model_fields[name].alias or name] = inspect.cleandoc(meaning)
    return found


def _rows(
    fields: Mapping[str, FieldInfo], schema: Schema, meaning: Mapping[str, str]
) -> Iterator[str]:
    yield "| Key | Type | Default | Meaning |"
    yield "|---|---|---|---|"
    for key, field in fields.items():
        type_ = _type(schema["properties"][key], schema.get("$defs", {}))
        default = "required" if field.is_required() else _default(field.default)
        yield f"| `{key}` | {type_} | {default} | {_markdown(meaning[key])} |"


def _markdown(text: str) -> str:
    paragraph = " ".join(text.partition("\n\n")[0].split())
    return re.sub(r'"[\w-]+"', r"`\g<0>`", paragraph.replace("``", "`"))


def _default(value: object) -> str:
    is_empty = value is None or value in ([], {}) or isinstance(value, BaseModel)
    return "none" if is_empty else f"`{_toml(value)}`"


_SIMPLE: Final = {
    "string": "text",
    "number": "number",
    "integer": "whole number",
    "boolean": "`true` or `false`",
    "object": "table",
}
_NULL: Final = {"type": "null"}


def _type(schema: Schema, defs: Mapping[str, Schema], ending: str = "") -> str:
    match schema:
        case {"$ref": str(reference)}:
            return _type(defs[reference.rpartition("/")[2]], defs, ending)
        case {"enum": choices} | {"const": choices}:
            return _either(f"`{json.dumps(each)}`" for each in _as_list(choices))
        case {"anyOf": forms}:
            names = [_type(form, defs, ending) for form in forms if form != _NULL]
            # A formula may also be a number.
            return _either(names).replace(f"text{ending} or number{ending}", f"formula{ending}")
        case {"format": "date-time"}:
            return f"date{ending} and time{ending} with a time zone"
        case {"type": "array", "prefixItems": [first, *more]}:
            return f"list{ending} of {len(more) + 1} {_type(first, defs, 's')}"
        case {"type": "array", "items": entry}:
            return f"list{ending} of {_type(entry, defs, 's')}"
        case _:
            name = _SIMPLE.get(schema.get("type", "object"), "table")
            return f"{name}{'' if name.startswith('`') else ending}{_bounds(schema)}"


def _as_list(value: object) -> list[object]:
    return value if isinstance(value, list) else [value]


def _either(names: Iterable[str]) -> str:
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last


def _bounds(schema: Schema) -> str:
    words = {"exclusiveMinimum": "over", "minimum": "from", "maximum": "up to"}
    return "".join(f" {word} {schema[key]:g}" for key, word in words.items() if key in schema)


def _toml(value: object) -> str:
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(each)}' for key, each in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return f"{value:g}" if isinstance(value, float) else json.dumps(value, ensure_ascii=False)


if __name__ == "__main__":
    sys.stdout.write(page())
