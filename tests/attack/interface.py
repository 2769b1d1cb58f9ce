"""Requests that schemathesis makes up from the OpenAPI document, with all its checks."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.server.raw import Service

# What is right by its shape is refused all the same where it names another exercise or part (404,
# 422), or asks for solutions that are not shown (403).
CONFIG = """
[checks.positive_data_acceptance]
expected-statuses = ["2xx", 403, 404, 422]
"""


def as_taken(document: dict[str, Any]) -> dict[str, Any]:
    """The OpenAPI document, with what the service takes beyond it.

    A field that may be left out may be null, and each of many submissions is checked by itself.
    """
    schemas = document["components"]["schemas"]
    for schema in schemas.values():
        required = schema.get("required", ())
        for name, field in schema.get("properties", {}).items():
            if name not in required and "default" not in field:
                schema["properties"][name] = {"anyOf": [field, {"type": "null"}]}
    schemas["GradeManyRequest"]["properties"]["submissions"]["items"] = {}
    return document


def faults(running: Service, folder: Path, examples: int, *options: str) -> Iterator[str]:
    """Try every operation with so many requests; what schemathesis says if a check fails."""
    [answer] = running.ask(b"GET /openapi.json HTTP/1.1\r\nHost: x\r\n\r\n")
    document, config = folder / "openapi.json", folder / "schemathesis.toml"
    document.write_text(json.dumps(as_taken(answer.json())), encoding="utf-8")
    config.write_text(CONFIG, encoding="utf-8")
    command = [
        sys.executable, "-m", "schemathesis.cli", "--config-file", str(config), "--no-color",
        "run", str(document), "--url", f"http://127.0.0.1:{running.port}",
        "--checks", "all", "--max-examples", str(examples), "--warnings", "off", *options,
    ]  # fmt: skip
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        yield f"{done.stdout}\n{done.stderr}"
