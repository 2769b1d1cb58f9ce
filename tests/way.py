"""Count what the grader does for an answer: ``python -m tests.way``, in a fresh process.

Prints JSON: the counts of each answer to the table of the Stanford arm, and the number of our
modules that the service has imported when it has graded its first answer.
"""

import asyncio
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, Final

import dh_grader

PACKAGE: Final = str(Path(dh_grader.__file__).parent)
EXERCISE: Final = "stanford-arm"
PART: Final = "table"

Rows = Sequence[Sequence[str]]
RIGHT: Final[Rows] = (
    ("0", "-pi/2", "0", "theta1"),
    ("0", "pi/2", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "-pi/2", "0", "theta4"),
    ("0", "pi/2", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
)
# The student has chosen the other directions of z1 and z2.
OTHER_FRAMES: Final[Rows] = (
    ("0", "pi/2", "0", "theta1"),
    ("0", "-pi/2", "-d2", "pi - theta2"),
    ("0", "pi", "-d3", "-pi"),
    *RIGHT[3:],
)
WRONG_SIGN: Final[Rows] = (RIGHT[0], ("0", "-pi/2", "d2", "theta2"), *RIGHT[2:])
_TURNED: Final = {"0": "pi/2", "pi/2": "0", "-pi/2": "0"}
WRONG_TWISTS: Final[Rows] = [(a, _TURNED[alpha], d, theta) for a, alpha, d, theta in RIGHT]
CSV: Final = "\n".join(",".join(row) for row in (("a", "alpha", "d", "theta"), *RIGHT))
TOOLBOX: Final = """\
L(1) = Link('d', 0, 'a', 0, 'alpha', -pi/2);
L(2) = Link('d', d2, 'a', 0, 'alpha', pi/2);
L(3) = Link('theta', 0, 'a', 0, 'alpha', 0);
L(4) = Link('d', 0, 'a', 0, 'alpha', -pi/2);
L(5) = Link('d', 0, 'a', 0, 'alpha', pi/2);
L(6) = Link('d', d6, 'a', 0, 'alpha', 0);
robot = SerialLink(L, 'name', 'Stanford');
"""
ANSWERS: Final[Mapping[str, Rows | str]] = {
    "right": RIGHT,
    "right, other frames": OTHER_FRAMES,
    "one wrong sign": WRONG_SIGN,
    "all twists wrong": WRONG_TWISTS,
    "right, pasted as CSV": CSV,
    "right, pasted as a toolbox script": TOOLBOX,
}
# Newer versions of Python run comprehensions within the function around them.
_COMPREHENSIONS: Final = ("<listcomp>", "<setcomp>", "<dictcomp>")


class Way:
    """A function for ``sys.setprofile`` that counts what runs of the package.

    A switch is a call of a function in another file than that of the call before.
    """

    def __init__(self) -> None:
        self._functions: set[CodeType] = set()
        self._calls = self._switches = self._deepest = self._depth = 0
        self._file = ""

    def __call__(self, frame: FrameType, event: str, _: object) -> None:
        """Count an event."""
        code = frame.f_code
        if not code.co_filename.startswith(PACKAGE) or code.co_name in _COMPREHENSIONS:
            return
        if event == "call":
            self._functions.add(code)
            self._calls += 1
            self._switches += code.co_filename != self._file
            self._file = code.co_filename
            self._depth += 1
            self._deepest = max(self._deepest, self._depth)
        elif event == "return":
            self._depth -= 1

    @property
    def counts(self) -> dict[str, int]:
        """The counts so far, by their names."""
        return {
            "files": len({code.co_filename for code in self._functions}),
            "functions": len(self._functions),
            "calls": self._calls,
            "depth": self._deepest,
            "switches": self._switches,
        }


def posted(answer: Rows | str) -> dict[str, Any]:
    """Return the result of posting an answer to the table to the service."""
    from dh_grader.app import app

    body = json.dumps({"answers": {PART: answer}}).encode()
    pieces: list[bytes] = []

    async def receive() -> dict[str, Any]:
        return {"type": "http.request", "body": body, "more_body": False}

    async def send(message: Any) -> None:
        pieces.append(message.get("body", b""))

    path = f"/v1/exercises/{EXERCISE}/grade"
    headers = [(b"host", b"127.0.0.1"), (b"content-type", b"application/json")]
    scope = {
        "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "scheme": "http",
        "method": "POST", "path": path, "raw_path": path.encode(), "query_string": b"",
        "root_path": "", "client": ("127.0.0.1", 1), "server": ("127.0.0.1", 80),
        "headers": [*headers, (b"content-length", str(len(body)).encode())],
    }  # fmt: skip
    asyncio.run(app(scope, receive, send))
    found: dict[str, Any] = json.loads(b"".join(pieces))
    return found


def imported() -> int:
    """Return the number of our modules that are imported, without empty ones."""
    ours = [each for name, each in sys.modules.items() if f"{name}.".startswith("dh_grader.")]
    return sum(1 for each in ours if each.__file__ and Path(each.__file__).stat().st_size)


def traced(answer: Rows | str) -> dict[str, object]:
    """Return the counts of grading an answer that was graded before, with its points."""
    from dh_grader.catalogue import load_exercise, shipped_folder
    from dh_grader.grading import Submission, grade

    exercise = load_exercise(shipped_folder() / f"{EXERCISE}.toml")
    submission = Submission({PART: answer if isinstance(answer, str) else [*map(list, answer)]})
    grade(exercise, submission)
    way = Way()
    sys.setprofile(way)
    try:
        report = grade(exercise, submission)
    finally:
        sys.setprofile(None)
    return {"points": report.points, **way.counts}


def main() -> None:
    """Print all counts as JSON."""
    first = posted(RIGHT)
    modules = imported()
    ways = {name: traced(answer) for name, answer in ANSWERS.items()}
    print(json.dumps({"points": first["points"], "modules": modules, "ways": ways}, indent=2))  # noqa: T201


if __name__ == "__main__":
    main()
