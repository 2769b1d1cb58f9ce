"""Print every figure that has a budget, beside the budget and a plain-numpy floor.

With ``--against DIR``, print instead each line as a multiple of the floor here and in another
checkout, both measured in turn; exit with 1 where a line is slower here by more than 3 %.
"""

import argparse
import os
import re
import tempfile
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from service.catalogue import Exercise, load_catalogue, load_exercise, shipped_folder
from service.expressions import read
from service.grading import Submission, grade
from service.kinematics.chain import pose
from service.kinematics.dh import Convention
from tests.benchmarks import answers, floors, paired, server
from tests.benchmarks.timing import median_of_each, median_seconds

ENTRY = "-s1*(d3*s2 + d2*c2) + d2*c1"


def with_free_frames(exercise_id: str) -> Exercise:
    """The shipped exercise with its table part set to free frames, if it is not."""
    text = (shipped_folder() / f"{exercise_id}.toml").read_text(encoding="utf-8")
    if 'frames = "free"' not in text:
        text = re.sub(r'(kind = "dh_table"\n)', r'\1frames = "free"\n', text, count=1)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{exercise_id}.toml"
        file.write_text(text, encoding="utf-8")
        return load_exercise(file)


def kinematics_seconds() -> float:
    """Forward kinematics of a 6-joint chain at 64 samples."""
    cells = np.random.default_rng(0).uniform(-1, 1, (6, 4, 64))
    return median_seconds(lambda: pose(cells, Convention.STANDARD), 200)


def in_process() -> list[tuple[str, float, float | None]]:
    """What, its median in milliseconds, and its budget in milliseconds."""
    exercise = load_catalogue(shipped_folder())["stanford-arm"]
    free = with_free_frames("stanford-arm")

    def graded_table(rows: answers.Rows) -> float:
        submission = Submission({"table": answers.table(rows)})
        return median_seconds(lambda: grade(free, submission)) * 1e3

    warm = Submission({"pose": answers.T06})
    vocabulary = exercise.vocabulary
    return [
        (
            "plain-numpy floor: 32 samples drawn, 6 links, product",
            median_seconds(lambda: floors.stanford_pose(32)) * 1e3,
            None,
        ),
        ("chain kinematics, 64 samples × 6 links", kinematics_seconds() * 1e3, 0.060),
        (
            "one typical entry read, cold",
            median_of_each(lambda i: read(f"{ENTRY} + {i + 9}*d6", vocabulary)) * 1e3,
            0.1,
        ),
        (
            "4×4 matrix of 16 entries graded, warm",
            median_seconds(lambda: grade(exercise, warm)) * 1e3,
            0.3,
        ),
        (
            "4×4 matrix of 16 entries graded, cold",
            median_of_each(
                lambda i: grade(exercise, Submission({"pose": answers.distinct(answers.T06, i)}))
            )
            * 1e3,
            2.0,
        ),
        (
            "wrong pose of a 6-joint arm, explained by slips of its table",
            median_of_each(
                lambda i: grade(
                    exercise,
                    Submission({"pose": answers.distinct(answers.standing_still(), i, point="")}),
                )
            )
            * 1e3,
            4.0,
        ),
        ("6-row table, the reference's frames", graded_table(answers.STANFORD), 0.4),
        ("6-row table, own frames", graded_table(answers.turned_over()), 0.4),
        ("6-row table, one slip, diagnosed", graded_table(answers.with_one_slip()), 4.0),
        ("6-row table, two slips, diagnosed", graded_table(answers.with_two_slips()), 4.0),
        (
            "6-row table, other convention, diagnosed",
            graded_table(answers.in_other_convention()),
            4.0,
        ),
    ]


def print_budgets(*, with_server: bool) -> None:
    """Print each figure of this checkout beside its budget."""
    figures = in_process()
    floor = figures[0][1]
    printed = Table("what", "median", "× floor", "budget", "")
    for what, milliseconds, budget in figures:
        printed.add_row(
            what,
            f"{milliseconds:.3f} ms",
            f"{milliseconds / floor:.1f}",
            f"{budget:.2f} ms" if budget else "",
            "" if budget is None else "ok" if milliseconds <= budget else "over",
        )
    if with_server:
        for what, bodies in server.BODIES.items():
            speed = server.posts_per_second(bodies)
            share = speed["graded"] / speed["trivial"]
            printed.add_row(
                f"trivial validated POSTs of the size: {what}", f"{speed['trivial']:.0f} /s"
            )
            printed.add_row(
                f"graded POSTs, every body different: {what}",
                f"{speed['graded']:.0f} /s",
                f"{share:.0%} of trivial",
                "25 %, aim 40 %",
                "ok" if share >= 0.25 else "under",
            )
        one = server.graded_per_second(1)
        for workers in (2, 3):
            many = server.graded_per_second(workers)
            printed.add_row(
                f"graded POSTs with {workers} workers, on {os.cpu_count()} cores",
                f"{many:.0f} /s",
                f"{many / one:.1f} × one worker",
            )
        first = min(server.first_answer_seconds() for _ in range(3))
        printed.add_row(
            "first graded answer after start",
            f"{first:.2f} s",
            "",
            "1 s",
            "ok" if first <= 1 else "over",
        )
    Console(width=120).print(printed)


def print_comparison(there: Path, rounds: int, *, with_server: bool) -> bool:
    """Print each line of this checkout beside that of another; return whether none is slower."""
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
    """Measure and print; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--no-server", action="store_true", help="leave out what needs a server")
    parser.add_argument("--against", type=Path, metavar="DIR", help="another checkout")
    parser.add_argument("--rounds", type=int, default=7, help="of both checkouts (7)")
    options = parser.parse_args()
    with_server = not options.no_server
    if options.against is None:
        print_budgets(with_server=with_server)
        return 0
    there = options.against.resolve()
    return 0 if print_comparison(there, options.rounds, with_server=with_server) else 1


if __name__ == "__main__":
    raise SystemExit(main())
