"""Write sample submissions into a folder: correct, wrong, unreadable and hostile."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from tests.formats.submissions import POSE, ROWS, WRITTEN

EXERCISE: Final = "planar-rrr"
# A shell that evaluated the names of hostile files would create a file of this name.
MARK: Final = "broken-out"


def write(folder: Path, answers: object) -> None:
    (folder / f"{EXERCISE}.json").write_text(json.dumps({"answers": answers}), encoding="utf-8")


def right(folder: Path) -> None:
    write(folder, {"table": {"rows": ROWS}, "pose": POSE})


def wrong(folder: Path) -> None:
    rows = [ROWS[0], {**ROWS[1], "alpha": "pi/2"}, *ROWS[2:]]
    write(folder, {"table": {"rows": rows}, "pose": POSE.replace("-s123", "s123")})


def unreadable(folder: Path) -> None:
    (folder / f"{EXERCISE}.json").write_bytes(b'\xff\xfe{"answers": \x1b[31m')


def missing(folder: Path) -> None:
    pass


def hostile(folder: Path) -> None:
    write(folder, {"table": {"rows": ROWS}, "pose": WRITTEN})
    for name in (
        f"$(touch {MARK}).json",
        f"`touch {MARK}`.csv",
        f"; touch {MARK} #.txt",
        f"a b' \" && touch {MARK}.json",
        "--format=json",
        "-",
        "..\\..\\results.json",
        "%2e%2e%2fresults.json",
        "*",
        "\x1b[31mred\x07\n::set-output name=score::1\n##[error]x.json",
        "<script>alert(1)</script>.json".replace("/", "\u2044"),
    ):
        (folder / name).write_text(f"$(touch {MARK})\n::set-output name=a::b\n", encoding="utf-8")
    (folder / "out.json").symlink_to("/etc/passwd")
    (folder / "sitecustomize.py").write_text(f"open({MARK!r}, 'w')\n", encoding="utf-8")
    (folder / "service").mkdir()
    (folder / "service" / "__init__.py").write_text(f"open({MARK!r}, 'w')\n", encoding="utf-8")


SORTS: Final[dict[str, Callable[[Path], None]]] = {
    made.__name__: made for made in (right, wrong, unreadable, missing, hostile)
}


def assert_nothing_ran(place: Path, *texts: str) -> None:
    """Assert that no file name or text was run as a command."""
    assert not list(place.rglob(MARK))
    for text in texts:
        assert "\x1b" not in text
        assert "\x07" not in text
        assert "<script" not in text
        assert "root:" not in text
        assert not [line for line in text.splitlines() if line.startswith(("::set-output", "##["))]


def points_of(result: dict[str, Any]) -> float:
    return sum(float(test["score"]) for test in result["tests"])
