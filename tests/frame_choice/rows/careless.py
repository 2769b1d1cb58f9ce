"""``python -m tests.frame_choice.rows.careless``: empty cells in tables with wrong rows."""

# The robots are put together from the rows of textbook arms. Their tables have the reference's
# frames or reversed x axes. Whole rows are wrong: rows are exchanged, in degrees, extra, missing or
# copied, or from some row on, a and α follow the other convention. As in `blanking`, an empty row
# or cell must not raise the points.

import argparse
import sys
from collections.abc import Iterator

import numpy as np

from tests.frame_choice.robots import ALPHA, MODIFIED, POLICIES, STANDARD, THETA, A, Robot
from tests.frame_choice.rows.blanking import MOST, Found, judge
from tests.frame_choice.rows.student_rows import StudentRowsTexts as Texts

LINKS = (("0", "pi/2"), ("0", "-pi/2"), ("0", "0"), ("b1", "0"), ("b2", "0"), ("0.35", "pi/2"))
OFFSETS = ("0", "0", "b3", "0.42")
MOST_JOINTS = 6
TABLES_OF_EACH = 4


def robot_of(number: int, seed: int) -> Robot:
    """Return a robot that is made of textbook rows."""
    rng = np.random.default_rng([seed, number, 77])
    count = int(rng.integers(2, MOST_JOINTS + 1))
    structure = "".join("P" if rng.random() < 0.25 else "R" for _ in range(count))
    rows = []
    for i, kind in enumerate(structure):
        a, alpha = LINKS[int(rng.integers(len(LINKS)))]
        offset = OFFSETS[int(rng.integers(len(OFFSETS)))]
        turned = "0" if rng.random() < 0.7 else "pi/2"
        rows.append(
            (a, alpha, f"q{i + 1}", turned) if kind == "P" else (a, alpha, offset, f"q{i + 1}")
        )
    convention = STANDARD if rng.random() < 0.5 else MODIFIED
    if convention == MODIFIED and rng.random() < 0.7:
        rows.append(("b2", "0", "0", "0"))
    joints = tuple(f"q{i + 1}" for i in range(count))
    return Robot(
        f"textbook {number}", structure, convention, joints, tuple(rows), ("b1", "b2", "b3")
    )


def with_reversed_x(robot: Robot, rng: np.random.Generator) -> Texts:
    texts = [list(row) for row in robot.rows]
    for i in range(len(texts) - 1):
        if rng.random() < 0.25:
            link = i + (robot.convention == MODIFIED)
            for column in (A, ALPHA):
                texts[link][column] = _negated(texts[link][column])
            texts[i][THETA] = _turned(texts[i][THETA], "+")
            texts[i + 1][THETA] = _turned(texts[i + 1][THETA], "-")
    return texts


def _negated(text: str) -> str:
    if text == "0":
        return text
    return text[1:] if text.startswith("-") else f"-{text}"


def _turned(text: str, sign: str) -> str:
    return "pi" if text == "0" else f"{text} {sign} pi"


def careless(texts: Texts, robot: Robot, rng: np.random.Generator) -> Iterator[tuple[str, Texts]]:
    first = list(_slips(texts, robot, rng))
    yield from first
    name, slipped = first[int(rng.integers(len(first)))]
    for other, both in _slips(slipped, robot, rng):
        yield f"{name} and {other}", both


def _slips(texts: Texts, robot: Robot, rng: np.random.Generator) -> Iterator[tuple[str, Texts]]:
    rows = [list(row) for row in texts]
    count = len(rows)
    if count > 1:
        i = int(rng.integers(count - 1))
        yield "exchanged", [*rows[:i], rows[i + 1], rows[i], *rows[i + 2 :]]
        yield "copied", [*rows[: i + 1], rows[i], *rows[i + 2 :]]
    if count > 2:
        i = int(rng.integers(count))
        yield "missing", [row for k, row in enumerate(rows) if k != i]
    i = int(rng.integers(count + 1))
    yield "extra", [*rows[:i], ["0.2", "pi/2", "0", "0"], *rows[i:]]
    i = int(rng.integers(count))
    degrees = [text.replace("pi/2", "90").replace("pi", "180") for text in rows[i]]
    yield "degrees", [degrees if k == i else row for k, row in enumerate(rows)]
    i = int(rng.integers(count))
    step = 1 if robot.convention == MODIFIED else -1
    moved = [
        [*rows[k + step][:2], *row[2:]] if i <= k < count and 0 <= k + step < count else row
        for k, row in enumerate(rows)
    ]
    yield "mixed conventions", moved


def run(robots: range, tries: int, seed: int) -> Found:
    found = Found()
    for number in robots:
        robot, rng = robot_of(number, seed), np.random.default_rng([seed, number, 78])
        enough = found.tries.total() + tries
        for _ in range(TABLES_OF_EACH):
            policy = POLICIES[0 if rng.random() < 0.5 else int(rng.integers(len(POLICIES)))]
            for sort, wrong in careless(with_reversed_x(robot, rng), robot, rng):
                if found.tries.total() < enough:
                    judge(found, sort, robot, policy, robot.convention, wrong, rng)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.frame_choice.rows.careless")
    parser.add_argument("--robots", type=int, default=40)
    parser.add_argument("--tries", type=int, default=50, help="tries with each robot")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--misses", type=int, default=5, help="misses to print")
    options = parser.parse_args()
    found = run(range(options.robots), options.tries, options.seed)
    gained = f"gained by an empty place: {found.gains.total()} of {found.tries.total()}"
    sys.stdout.write("\n".join([*found.misses[: options.misses], gained]) + "\n")
    return int(found.gains.total() > MOST * found.tries.total())


if __name__ == "__main__":
    sys.exit(main())
