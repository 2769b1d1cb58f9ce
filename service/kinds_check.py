"""The check, when the program starts, that every answer kind has its three files."""

from collections.abc import Mapping, Set
from pathlib import Path
from typing import Final

from service.catalogue.parts import SPECS, KindError
from service.grading.kinds import KINDS

_SOLUTIONS: Final = Path(__file__).parent / "solutions" / "kinds"


def check_kinds() -> None:
    """Check that catalogue, grading and solutions know the same kinds. Raises KindError."""
    # By their text: SymPy, which the model answers need, takes half a second to import.
    texts = {file.stem: file.read_text(encoding="utf-8") for file in _SOLUTIONS.glob("*.py")}
    solved = {
        kind for kind, text in texts.items() if "\ndef answer(" in text and "\ndef lazy(" in text
    }
    refuse_half_made(
        {
            "service/catalogue/parts": SPECS.keys(),
            "service/grading/kinds": KINDS.keys(),
            "service/solutions/kinds": solved,
        }
    )


def refuse_half_made(kinds: Mapping[str, Set[str]]) -> None:
    """Check that each folder has the same kinds. Raises KindError naming the files that lack."""
    problems = []
    for kind in sorted(frozenset[str]().union(*kinds.values())):
        lacking = [f"{folder}/{kind}.py" for folder, known in kinds.items() if kind not in known]
        if lacking:
            problems.append(f"The answer kind {kind!r} is half made: write {', '.join(lacking)}.")
    if problems:
        raise KindError("\n".join(problems))
