"""The examples in docs/notebook.md print the shown output."""

import contextlib
import inspect
import io
import re
from pathlib import Path
from typing import Any

import dh_grader
import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "notebook.md").read_text(encoding="utf-8")
_EXAMPLE = re.compile(r"^```python\n(.*?)^```\n.*?^```text\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_the_examples_print_the_shown_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    examples = _EXAMPLE.findall(PAGE)
    assert len(examples) == PAGE.count("```python") == 3
    names: dict[str, Any] = {}
    for program, printed in examples:
        page = io.StringIO()
        with contextlib.redirect_stdout(page):
            exec(program, names)  # noqa: S102 - our own page
        assert page.getvalue() == printed


def test_the_page_has_every_argument_with_its_default() -> None:
    arguments = inspect.signature(dh_grader.grade).parameters
    rows = dict(re.findall(r"^\| `(\w+)` \|.*\| ([^|]*) \|$", PAGE, re.MULTILINE))
    assert list(rows) == list(arguments)[2:]
    for name in ("angle_unit", "language"):
        assert rows[name] == f'`"{arguments[name].default}"`'
