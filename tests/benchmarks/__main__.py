"""Print every measured time with its limit.

Times are multiples of a fixed computation in numpy. With ``--against DIR``, compare this checkout
with the checkout in DIR; exit with 1 if a time is worse here by more than 3 %.
"""

import argparse
import os
import re
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from dh_grader.catalogue import Exercise, load_catalogue, load_exercise, shipped_folder
from dh_grader.expressions import read
from dh_grader.grading import Submission, grade
from dh_grader.kinematics import Convention, pose
from rich.console import Console
from rich.table import Table

from tests.benchmarks import answers, paired, server, starts
from tests.benchmarks.timing import floor_seconds, multiple, multiple_of_each

ENTRY = "-s1*(d3*s2 + d2*c2) + d2*c1"


def with_free_frames(exercise_id: str) -> Exercise:
    text = (shipped_folder() / f"{exercise_id}.toml").read_text(encoding="utf-8")
    if 'frames = "free"' not in text:
        text = re.sub(r'(kind = "dh_table"\n)', r'\1frames = "free"\n', text, count=1)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{exercise_id}.toml"
        file.write_text(text, encoding="utf-8")
        return load_exercise(file)


# The budget of each line, in multiples of the floor.
BUDGETS = {
    "chain kinematics, 64 samples × 6 links": 0.5,
    "4×4 matrix of 16 entries graded, warm": 2.5,
    "4×4 matrix of 16 entries graded, cold": 10.0,
    "6-row table, the reference's frames": 2.0,
    "6-row table, own frames": 3.5,
    "6-row table, one slip, diagnosed": 12.0,
    "6-row table, two slips, diagnosed": 25.0,
    "6-row table, other convention, diagnosed": 25.0,
    "wrong pose of a 6-joint arm, explained by slips of its table": 40.0,
}
# The least throughput of graded POSTs, as a share of trivial ones on the same server.
SHARES = {
    "right tables": 0.40,
    "tables, one in three wrong": 0.20,
    "the same and new poses": 0.08,
}
# The least throughput of recorded POSTs, as a share of those that are only graded.
RECORDED_SHARE = 2 / 3
FIRST_ANSWER_SECONDS = 1.0
# The budget of a whole process in seconds, including its start.
START_SECONDS = {"dh-grader --help": 0.3, "dh-grader grade, one file": 0.8}


def in_process() -> dict[str, float]:
    exercise = load_catalogue(shipped_folder())["stanford-arm"]
    free = with_free_frames("stanford-arm")
    vocabulary = exercise.vocabulary
    links = np.random.default_rng(0).uniform(-1, 1, (6, 4, 64))
    warm = Submission({"pose": answers.T06})

    def graded_table(rows: answers.Rows) -> float:
        submission = Submission({"table": answers.table(rows)})
        return multiple(lambda: grade(free, submission))

    def graded_poses(pose_of: Callable[[int], list[list[str]]]) -> float:
        return multiple_of_each(lambda i: grade(exercise, Submission({"pose": pose_of(i)})))

    standing = answers.standing_still()
    return {
        "chain kinematics, 64 samples × 6 links": multiple(
            lambda: pose(links, Convention.STANDARD)
        ),
        "one typical entry read, cold": multiple_of_each(
            lambda i: read(f"{ENTRY} + {i + 9}*d6", vocabulary)
        ),
        "4×4 matrix of 16 entries graded, warm": multiple(lambda: grade(exercise, warm)),
        "4×4 matrix of 16 entries graded, cold": graded_poses(
            lambda i: answers.distinct(answers.T06, i)
        ),
        "wrong pose of a 6-joint arm, explained by slips of its table": graded_poses(
            lambda i: answers.distinct(standing, i, point="")
        ),
        "6-row table, the reference's frames": graded_table(answers.STANFORD),
        "6-row table, own frames": graded_table(answers.turned_over()),
        "6-row table, one slip, diagnosed": graded_table(answers.with_one_slip()),
        "6-row table, two slips, diagnosed": graded_table(answers.with_two_slips()),
        "6-row table, other convention, diagnosed": graded_table(answers.in_other_convention()),
    }


def print_budgets(*, with_server: bool) -> None:
    """Print each measured time of this checkout with its limit."""
    floor = floor_seconds()
    printed = Table("what", "here", "asked", "", "milliseconds")
    printed.add_row(
        "plain-numpy floor: 32 samples drawn, 6 links, product", "1", "", "", f"{floor * 1e3:.3f}"
    )
    for what, times in in_process().items():
        budget = BUDGETS.get(what)
        printed.add_row(
            what,
            f"{times:.2f}",
            "" if budget is None else f"≤ {budget:g}",
            "" if budget is None else "met" if times <= budget else "missed",
            f"{times * floor * 1e3:.3f}",
        )
    add_starts(printed)
    if with_server:
        add_server_lines(printed)
    Console(width=120).print(printed)


def add_starts(printed: Table) -> None:
    times = starts.start_seconds()
    numpy_alone = next(iter(times.values()))
    for what, seconds in times.items():
        most = START_SECONDS.get(what)
        printed.add_row(
            f"{what} ({seconds / numpy_alone:.1f} times numpy alone)",
            f"{seconds:.2f} s",
            "" if most is None else f"≤ {most:g} s",
            "" if most is None else "met" if seconds <= most else "missed",
            f"{seconds * 1e3:.0f}",
        )


def add_server_lines(printed: Table) -> None:
    for what, bodies in server.BODIES.items():
        speed = server.posts_per_second(bodies)
        share = speed["graded"] / speed["trivial"]
        printed.add_row(
            f"graded POSTs of trivial ones ({speed['trivial']:.0f} /s): {what}",
            f"{share:.1%}",
            f"≥ {SHARES[what]:.0%}",
            "met" if share >= SHARES[what] else "missed",
            f"{1e3 / speed['graded']:.3f}",
        )
    for what, speed in (
        ("POSTs recorded in SQLite", server.recorded_per_second()),
        ("hand-ins in an assignment", server.handed_in_per_second()),
    ):
        graded, recorded = speed.values()
        share = recorded / graded
        printed.add_row(
            f"{what} of graded ones ({graded:.0f} /s)",
            f"{share:.1%}",
            f"≥ {RECORDED_SHARE:.0%}",
            "met" if share >= RECORDED_SHARE else "missed",
            f"{1e3 / recorded:.3f}",
        )
    one = server.graded_per_second(1)
    for workers in (2, 3):
        many = server.graded_per_second(workers)
        printed.add_row(
            f"graded POSTs with {workers} workers on {os.cpu_count()} cores, of those with one",
            f"{many / one:.2f}",
            "",
            "",
            f"{1e3 / many:.3f}",
        )
    first = min(server.first_answer_seconds() for _ in range(3))
    printed.add_row(
        "first graded answer after start",
        f"{first:.2f} s",
        f"≤ {FIRST_ANSWER_SECONDS:g} s",
        "met" if first <= FIRST_ANSWER_SECONDS else "missed",
        f"{first * 1e3:.0f}",
    )


def print_comparison(there: Path, rounds: int, *, with_server: bool) -> bool:
    lines = paired.compare(there, rounds, with_server=with_server)
    printed = Table(f"median of {rounds}, × floor", "here", str(there), "here / there", "")
    for line in lines:
        printed.add_row(
            line.what,
            f"{line.here:.2f}",
            f"{line.there:.2f}",
            f"{line.ratio:.3f}",
            "slower" if line.slower else "ok",
        )
    Console(width=120).print(printed)
    return not any(line.slower for line in lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--no-server", action="store_true", help="omit figures that need a server")
    parser.add_argument("--against", type=Path, metavar="DIR", help="another checkout")
    parser.add_argument("--rounds", type=int, default=7, help="rounds of both checkouts (7)")
    options = parser.parse_args()
    with_server = not options.no_server
    if options.against is None:
        print_budgets(with_server=with_server)
        return 0
    there = options.against.resolve()
    return 0 if print_comparison(there, options.rounds, with_server=with_server) else 1


if __name__ == "__main__":
    raise SystemExit(main())
