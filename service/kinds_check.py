"""Check at startup that every kind of answer can be read, graded and solved."""

from collections.abc import Mapping, Set
from pathlib import Path
from typing import Final

from service.catalogue.parts import SPECS, KindError
from service.grading.kinds import KINDS

_SOLUTIONS: Final = Path(__file__).parent / "solutions" / "kinds"


def check_kinds() -> None:
    """Raise KindError unless catalogue, grading and solutions have the same kinds of answers."""
    # Read the text of the solutions: importing them would load SymPy, which takes half a second.
    texts = {file.stem: file.read_text(encoding="utf-8") for file in _SOLUTIONS.glob("*.py")}
    solved = {
        kind for kind, text in texts.items() if "\ndef answer(" in text and "\ndef lazy(" in text
    }
    require_complete(
        {
            "service/catalogue/parts": SPECS.keys(),
            "service/grading/kinds": KINDS.keys(),
            "service/solutions/kinds": solved,
        }
    )


def require_complete(kinds: Mapping[str, Set[str]]) -> None:
    """Raise KindError unless all folders have the same kinds of answers."""
    problems = []
    for kind in sorted(frozenset[str]().union(*kinds.values())):
        missing = [f"{folder}/{kind}.py" for folder, known in kinds.items() if kind not in known]
        if missing:
            problems.append(f"The answer kind {kind!r} is incomplete: write {', '.join(missing)}.")
    if problems:
        raise KindError("\n".join(problems))
