"""Test the service with requests that schemathesis generates from the OpenAPI document."""

import subprocess
import sys
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.keys import add_key
from dh_grader.store.database import in_transaction, open_database

from tests.server.raw import Service

# A request that matches the schema may still be refused: if it names an unknown exercise or part
# (404, 422), or asks for solutions that are not shown (403).
CONFIG = """
[checks.positive_data_acceptance]
expected-statuses = ["2xx", 403, 404, 422]

# A batch with a submission that does not match the schema gets a problem in its place.
[[operations]]
include-operation-id = "gradeMany"
[operations.checks.negative_data_rejection]
expected-statuses = [200, "4xx"]
"""


SECRET: Final = "0123456789abcdef" * 4


def with_key(folder: Path) -> tuple[dict[str, str], str]:
    database = str(folder / "attempts.db")
    text, now = new_key_text(), datetime.now(UTC)
    until = now + timedelta(days=1)
    digest = Secret(SECRET).key_digest(text)
    engine = open_database(database)
    in_transaction(engine, lambda c: add_key(c, "a", digest, list(Scope), None, now, until))
    engine.dispose()
    return {"DH_GRADER_DATABASE": database, "DH_GRADER_SECRET": SECRET}, text


def faults(
    running: Service, folder: Path, examples: int, *options: str, key: str = ""
) -> Iterator[str]:
    [answer] = running.ask(b"GET /openapi.json HTTP/1.1\r\nHost: x\r\n\r\n")
    document, config = folder / "openapi.json", folder / "schemathesis.toml"
    document.write_bytes(answer.body)
    config.write_text(CONFIG, encoding="utf-8")
    command = [
        sys.executable, "-m", "schemathesis.cli", "--config-file", str(config), "--no-color",
        "run", str(document), "--url", f"http://127.0.0.1:{running.port}",
        "--checks", "all", "--max-examples", str(examples), "--warnings", "off", *options,
        # The time to generate a request does not depend on the service.
        "--suppress-health-check", "too_slow",
        *(["--header", f"Authorization: Bearer {key}"] if key else []),
    ]  # fmt: skip
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        yield f"{done.stdout}\n{done.stderr}"
