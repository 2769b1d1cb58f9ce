"""The program reads every example in docs/expressions.md as the page says."""

import re
from pathlib import Path

import pytest
from dh_grader.expressions import LIMITS, ExpressionError, read

from tests.expressions.corpus_files import ROBOT
from tests.together import together

PAGE = (Path(__file__).parents[2] / "docs" / "expressions.md").read_text("utf-8")
_COLUMN = re.compile(r"(?<!\\)\|")


def rows(*heads: str) -> list[tuple[str, ...]]:
    found: list[tuple[str, ...]] = []
    inside = False
    for line in PAGE.split("\n"):
        cells = tuple(cell.strip() for cell in _COLUMN.split(line)[1:-1])
        if cells == heads:
            inside = True
        elif not cells:
            inside = False
        elif inside and not set(cells[0]) <= {"-"}:
            found.append(tuple(cell.strip("`").replace(r"\|", "|") for cell in cells))
    assert found
    return found


@together(("text", "meaning"), rows("You type", "It means"))
def test_a_text_has_the_shown_meaning(text: str, meaning: str) -> None:
    assert read(text, ROBOT).text() == meaning


@pytest.mark.parametrize(("text", "meaning", "note"), rows("You type", "It means", "The note"))
def test_a_text_has_the_shown_meaning_and_note(text: str, meaning: str, note: str) -> None:
    expression = read(text, ROBOT)
    assert expression.text() == meaning
    assert note in {found.code for found in expression.notes}


@pytest.mark.parametrize(("text", "_why", "repaired"), rows("You type", "Why not", "Write"))
def test_a_refused_text_has_the_shown_repair(text: str, _why: str, repaired: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, ROBOT)
    assert caught.value.suggestion == repaired
    read(repaired, ROBOT)


@pytest.mark.parametrize(("text", "_why"), rows("You type", "Why not"))
def test_a_text_is_refused_without_a_repair(text: str, _why: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, ROBOT)
    assert caught.value.suggestion is None


def test_no_example_but_the_noted_ones_has_a_second_reading() -> None:
    plain = [text for text, _ in rows("You type", "It means")]
    notes = {text: {note.code for note in read(text, ROBOT).notes} for text in plain}
    assert {text for text, codes in notes.items() if codes - {"joint_marker"}} == set()


def test_the_limits_are_the_ones_in_force() -> None:
    words = " ".join(PAGE.split())
    assert f"{LIMITS.characters:,} characters, {LIMITS.nodes:,} operations and values" in words
    assert f"{LIMITS.depth} levels" in words
    assert f"{LIMITS.tree_depth} terms" in words
    assert f"no more than {LIMITS.repaired:,} characters" in words
