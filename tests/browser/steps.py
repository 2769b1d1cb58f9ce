"""The actions of a student on the page of an exercise."""

from collections.abc import Iterator, Sequence
from typing import Final

from dh_grader.catalogue import Exercise, PartSpec
from dh_grader.pasting import read_grid
from playwright.sync_api import Locator, Page, expect


def open_exercise(page: Page, service: str, exercise: str, fragment: str = "") -> None:
    """Open the page of an exercise and wait until it can be filled in."""
    page.goto(f"{service}/exercises/{exercise}{fragment}")
    expect(page.locator(".part").first).to_be_visible()


def cells(page: Page, part: int = 0) -> Locator:
    """Return the input fields of a part of the exercise."""
    return page.locator(".part").nth(part).locator("input")


def right_answers(exercise: Exercise) -> dict[str, list[str]]:
    """Return the correct entries of each part, from the checks in the exercise file."""
    found: dict[str, list[str]] = {}
    for check in exercise.checks:
        if check.kind == "right":
            for part, answer in check.answers.items():
                found.setdefault(part, [entry.strip() for entry in _entries(answer)])
    return found


def _entries(answer: object) -> Iterator[str]:
    match answer:
        case {"rows": rows}:
            yield from _entries(rows)
        case {"none": _}:
            return
        case {"a": a, "alpha": alpha, "d": d, "theta": theta}:
            yield from map(str, (a, alpha, d, theta))
        case list():
            for each in answer:
                yield from _entries(each)
        case str() if "\n" in answer:
            rows = [[cell.text for cell in row] for row in read_grid(answer).rows]
            heads = rows[0]
            width = 4 if "theta" in heads else len(heads)
            for row in rows[1:] if "theta" in heads else rows:
                yield from row[-width:]
        case _:
            yield str(answer)


def type_with_tab(page: Page, texts: Sequence[str]) -> None:
    """Type texts into consecutive cells, only with the keyboard."""
    for text in texts:
        page.keyboard.insert_text(text)
        page.keyboard.press("Tab")


def answer(page: Page, part: PartSpec, place: int, texts: Sequence[str]) -> None:
    """Answer a part of the exercise by keyboard, beginning at its first cell."""
    # Matrices are pasted, in the notation of MATLAB; all other answers are typed.
    if part.kind not in _MATRICES:
        return type_with_tab(page, texts)
    width = _MATRICES[part.kind]
    rows = [" , ".join(texts[i : i + width]) for i in range(0, len(texts), width)]
    matrices = [rows[i : i + width] for i in range(0, len(rows), width)]
    paste(page, "\n".join(f"A{i + 1} = [{'; '.join(each)}]" for i, each in enumerate(matrices)))
    expect(cells(page, place).first).not_to_have_value("")
    return None


_MATRICES: Final = {"link_transforms": 4, "transform": 4, "rotation": 3}


def paste(page: Page, text: str) -> None:
    """Paste a text from the real clipboard at the cursor."""
    page.evaluate("text => navigator.clipboard.writeText(text)", text)
    page.keyboard.press("Control+V")
