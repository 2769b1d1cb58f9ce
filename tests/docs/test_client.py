"""The examples in docs/client.md print the shown output."""

import contextlib
import io
import re
from pathlib import Path
from typing import Any

import pytest
from dh_grader import client
from dh_grader.client import Retries

from tests.api.serving import Served

PAGE = (Path(__file__).parents[2] / "docs" / "client.md").read_text(encoding="utf-8")
_EXAMPLE = re.compile(r"^```python\n(.*?)^```\n(.*?)^```text\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_SHOWN = "http://127.0.0.1:8000"


@pytest.mark.long
def test_the_examples_print_the_shown_output(server: Served) -> None:
    examples = _EXAMPLE.findall(PAGE)
    assert len(examples) == PAGE.count("```python") == 4
    names: dict[str, Any] = {}
    for program, _, printed in examples:
        page = io.StringIO()
        with contextlib.redirect_stdout(page):
            exec(program.replace(_SHOWN, server.address), names)  # noqa: S102 - our own page
        assert page.getvalue() == printed


def test_the_page_names_every_public_name() -> None:
    assert [name for name in client.__all__ if name not in PAGE] == []
    for method in re.findall(r"^\| `(\w+)\(", PAGE, re.MULTILINE):
        assert hasattr(client.GraderClient, method)
        assert hasattr(client.AsyncGraderClient, method)


def test_the_page_has_the_default_retries() -> None:
    usual = Retries()
    assert (usual.number, usual.first_wait, usual.longest_wait) == (5, 0.5, 30.0)
    assert "up to five times more" in PAGE.replace("\n", " ")
