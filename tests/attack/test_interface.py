"""A small sample of the requests that `make attack` makes up from the OpenAPI document."""

from pathlib import Path

from tests.attack.interface import faults
from tests.server.raw import service


def test_the_service_does_what_its_document_says(tmp_path: Path) -> None:
    sample = ["--phases", "examples,fuzzing", "--no-shrink", "--generation-database", "none"]
    with service(tmp_path) as running:
        assert list(faults(running, tmp_path, 3, "--seed", "1", *sample)) == []
