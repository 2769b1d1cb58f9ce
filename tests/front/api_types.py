"""Write the TypeScript types of the HTTP interface from the OpenAPI document.

Run ``python -m tests.front.api_types > service/dh_grader/web/types/api.d.ts``.
"""

import json
import sys
from collections.abc import Mapping
from typing import Any, Final

from dh_grader.app import app

Schema = Mapping[str, Any]

_HEAD: Final = "// Written by `python -m tests.front.api_types`. Do not edit.\n"
_PLAIN: Final = {
    "string": "string", "number": "number", "integer": "number", "boolean": "boolean",
    "null": "null",
}  # fmt: skip
_LINE: Final = 100


def api_types(document: Schema) -> str:
    """Return the schemas of an OpenAPI document as TypeScript types."""
    schemas = document["components"]["schemas"]
    types = [f"  type {name} = {_type(schema)};\n" for name, schema in sorted(schemas.items())]
    return f"{_HEAD}declare namespace Api {{\n{''.join(types)}}}\n"


def _type(schema: Schema) -> str:
    if "$ref" in schema:
        return str(schema["$ref"].rpartition("/")[2])
    if "const" in schema or "enum" in schema:
        return " | ".join(map(json.dumps, schema.get("enum") or [schema["const"]]))
    if either := schema.get("oneOf") or schema.get("anyOf"):
        return " | ".join(map(_type, either))
    if "type" not in schema:
        return "unknown"
    if schema["type"] == "array":
        return _array(schema)
    if schema["type"] == "object":
        return _object(schema)
    return _PLAIN[schema["type"]]


def _array(schema: Schema) -> str:
    if "prefixItems" in schema:
        return f"[{', '.join(map(_type, schema['prefixItems']))}]"
    item = _type(schema["items"])
    return f"({item})[]" if " | " in item else f"{item}[]"


def _object(schema: Schema) -> str:
    if "properties" not in schema:
        others = schema["additionalProperties"]
        return f"Record<string, {_type(others) if isinstance(others, dict) else 'unknown'}>"
    required = schema.get("required", ())
    fields = [
        f"{name}{'' if name in required else '?'}: {_type(field)};"
        for name, field in schema["properties"].items()
    ]
    line = " ".join(fields)
    if len(line) <= _LINE:
        return f"{{ {line} }}"
    return "{\n" + "".join(f"    {field}\n" for field in fields) + "  }"


if __name__ == "__main__":
    sys.stdout.write(api_types(app.openapi()))
