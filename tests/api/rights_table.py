"""Write the table of routes and required rights into docs/keys.md.

Run ``python -m tests.api.rights_table``.
"""

from pathlib import Path
from typing import Final

from dh_grader.api.permissions import RIGHTS, Right

PAGE: Final = Path(__file__).parents[2] / "docs" / "keys.md"
_HEADINGS: Final = (
    "Route",
    "Scope",
    "Exercises",
    "Token of a learner",
    "Key of a course",
    "Without keys",
)
_START: Final = f"| {' | '.join(_HEADINGS)} |\n"


def table() -> str:
    rows = [row(route, right) for route, right in RIGHTS.items() if right.scope is not None]
    return "".join([_START, f"|{'---|' * len(_HEADINGS)}\n", *rows])


def row(route: str, right: Right) -> str:
    """Return the line of the table for a route."""
    tokens = "yes" if right.tokens else "no"
    in_course = "yes" if right.in_course else "no"
    without = right.without_keys.value
    # A path parameter that may have slashes is written like the others.
    shown = route.replace(":path", "")
    cells = (f"`{shown}`", f"`{right.scope}`", right.reach.value, tokens, in_course, without)
    return f"| {' | '.join(cells)} |\n"


def with_table(page: str) -> str:
    before, start, rest = page.partition(_START)
    assert start, "docs/keys.md has no table of routes"
    return before + table() + "\n" + rest.partition("\n\n")[2]


if __name__ == "__main__":
    PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
