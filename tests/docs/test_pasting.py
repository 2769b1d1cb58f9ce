"""Each example of docs/pasting.md is read or refused as the page says."""

import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.reading.headers import read_header
from dh_grader.grading.report import MAX_PASTED
from dh_grader.pasting import GRID_LIMITS, GridError, read_grid, read_robot

from tests.grading.support.submitting import full_marks, handed_in, part

PAGE = (Path(__file__).parents[2] / "docs" / "pasting.md").read_text(encoding="utf-8")
BLOCKS = re.findall(
    r"^```\w+ (table|matrix|links|refused) ?(\w*)\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE
)
READ = [(kind, text) for kind, _, text in BLOCKS if kind != "refused"]
REFUSED = [(code, text) for kind, code, text in BLOCKS if kind == "refused"]

PARTS = {
    "table": ("rrrp", "table"),
    "matrix": ("planar-rrr", "pose"),
    "links": ("planar-rrr-standard", "links"),
}


def test_every_block_is_an_example() -> None:
    assert len(BLOCKS) == PAGE.count("\n```") / 2
    assert (len(READ), len(REFUSED)) == (30, 5)


@pytest.mark.parametrize(("kind", "text"), READ)
def test_an_example_gets_full_marks(
    kind: str, text: str, catalogue: Mapping[str, Exercise]
) -> None:
    exercise, part_id = PARTS[kind]
    report = part(handed_in(catalogue[exercise], {part_id: text}), part_id)
    assert full_marks(report), report


@pytest.mark.parametrize(("code", "text"), REFUSED)
def test_an_example_is_refused(code: str, text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_robot(text) or read_grid(text)
    assert caught.value.code == code


def test_the_headers_of_the_page() -> None:
    names = {"a": "a", "α": "alpha", "d": "d", "θ": "theta", "the row's label": "label"}
    rows = re.findall(r"^\| ([^|]+) \| (`.*) \|$", PAGE, re.MULTILINE)
    assert [name for name, _ in rows] == list(names)
    for name, spellings in rows:
        for spelling in re.findall(r"`([^`]+)`", spellings):
            header = read_header(spelling)
            assert header is not None
            assert header.column == names[name]


def test_the_limits_of_the_page() -> None:
    words = " ".join(PAGE.split())
    assert f"{GRID_LIMITS.characters:,} characters ({MAX_PASTED:,} in all texts" in words
    assert f"{GRID_LIMITS.rows - 1} rows and a header, {GRID_LIMITS.columns} columns" in words
