"""`dh-grader exercises check`: faults in exercise files, for their authors."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.text import Text

from service.authoring import Level, Remark, examine
from service.catalogue import CatalogueError, Exercise, exercise_files, load_exercise
from service.catalogue.lines import line_of, value_lines
from service.cli.terminal import UNUSABLE, complain, give_up, settings_or_exit, stdout

FAILED = 1

STYLES = {Level.FAILED: "red", Level.WARNING: "yellow"}


@dataclass(slots=True)
class Tally:
    """The number of files of each sort."""

    usable: int = 0
    unusable: int = 0
    failed: int = 0
    warned: int = 0

    def exit_code(self, *, strict: bool) -> int:
        """2 where a file cannot be used, 1 where a check failed (or, strictly, a warning is)."""
        if self.unusable:
            return UNUSABLE
        return FAILED if self.failed or (strict and self.warned) else 0


def command(
    path: Annotated[
        Path | None,
        typer.Argument(help="A file, or a folder of files; by default the whole catalogue."),
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Let warnings fail as well.")] = False,
) -> None:
    """Check exercise files: shape, model answer, the file's own checks, and what looks wrong.

    Exit code 0: every file can be used and passes, with warnings or without.

    Exit code 1: a check failed, or with --strict there is a warning.

    Exit code 2: a file cannot be used; other files are checked all the same.
    """
    console, tally = stdout(), Tally()
    files = _files(path)
    for file in files:
        _check(file, tally, console)
    if len(files) > 1:
        console.print(Text(_summary(tally), "bold"))
    raise SystemExit(tally.exit_code(strict=strict))


def _files(path: Path | None) -> list[Path]:
    try:
        if path is None:
            return exercise_files(*settings_or_exit().exercises_dir)
        return exercise_files(path) if path.is_dir() else [path]
    except CatalogueError as error:
        give_up(str(error))


def _check(file: Path, tally: Tally, console: Console) -> None:
    try:
        exercise = load_exercise(file)
    except CatalogueError as error:
        complain(str(error))
        tally.unusable += 1
        return
    remarks = examine(exercise)
    levels = {remark.level for remark in remarks}
    tally.usable += 1
    tally.failed += Level.FAILED in levels
    tally.warned += Level.WARNING in levels
    for line in _lines(exercise, remarks, file):
        # A line of its own for each remark, however long: other programs read this, too.
        console.print(line, soft_wrap=True)


def _lines(exercise: Exercise, remarks: list[Remark], file: Path) -> Iterator[Text]:
    failed = any(remark.level is Level.FAILED for remark in remarks)
    verdict = ("failed", STYLES[Level.FAILED]) if failed else ("ok", "green")
    parts = _count(len(exercise.parts), "part")
    checks = _count(len(exercise.checks), "check")
    yield Text.assemble((exercise.id, "bold"), ": ", verdict, f", {parts}, {checks}")
    lines = value_lines(file.read_text(encoding="utf-8")) if remarks else {}
    for remark in remarks:
        line = line_of(remark.field, lines)
        place = remark.field if line is None else f"{remark.field} (line {line})"
        yield Text.assemble(
            "  ", (remark.level.value, STYLES[remark.level]), f": {place}: {remark.text}"
        )


def _summary(tally: Tally) -> str:
    counts = [
        f"{_count(tally.usable + tally.unusable, 'exercise')}: {tally.usable - tally.failed} ok",
        *([f"{tally.failed} failed"] if tally.failed else []),
        *([f"{tally.unusable} cannot be used"] if tally.unusable else []),
        *([f"{tally.warned} with warnings"] if tally.warned else []),
    ]
    return ", ".join(counts)


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
