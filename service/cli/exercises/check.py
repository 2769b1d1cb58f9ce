"""`dh-grader exercises check`: find faults in exercise files."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.text import Text

from service.authoring import Level, Remark, examine, summary
from service.catalogue import (
    CatalogueError,
    Exercise,
    exercise_files,
    is_exercise_id,
    load_exercise,
)
from service.catalogue.files.lines import line_of, value_lines, with_line
from service.cli.exercises.variants import check_seeds
from service.cli.language import spoken
from service.cli.terminal import UNUSABLE, complain, give_up, installed_file, stdout
from service.settings import load_settings
from service.translations import joined, say, say_count

FAILED = 1

STYLES = {Level.FAILED: "red", Level.WARNING: "yellow"}


def command(
    path: Annotated[
        Path | None,
        typer.Argument(help="A file, a folder or an id; by default the whole catalogue."),
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Let warnings fail as well.")] = False,
    seeds: Annotated[
        int | None,
        typer.Option(min=1, max=10_000, help="Check this many variants of one exercise."),
    ] = None,
) -> None:
    """Check exercise files: their fields, model answers and own checks; warn of likely mistakes.

    Exit code 0: every file can be used and passes, with or without warnings.

    Exit code 1: a check failed, or there is a warning and --strict is given.

    Exit code 2: a file cannot be used; the other files are still checked.
    """
    console = stdout()
    if path is not None and not path.exists() and is_exercise_id(str(path)):
        path = installed_file(str(path))
    if seeds is not None:
        if path is None or path.is_dir():
            give_up(say("--seeds is for one exercise: name its file or its id."))
        raise SystemExit(FAILED if check_seeds(load_exercise(path), seeds, console) else 0)
    if path is None:
        files = exercise_files(*load_settings().exercises_dir)
    else:
        files = exercise_files(path) if path.is_dir() else [path]
    levels = [_check(file, console) for file in files]
    unusable = levels.count(None)
    found = Counter(level for remarked in levels for level in remarked or ())
    if len(files) > 1:
        console.print(Text(_summary(len(files), unusable, found), "bold"))
    if unusable:
        raise SystemExit(UNUSABLE)
    raise SystemExit(FAILED if found[Level.FAILED] or (strict and found[Level.WARNING]) else 0)


def _check(file: Path, console: Console) -> set[Level] | None:
    try:
        exercise = load_exercise(file)
    except CatalogueError as error:
        complain(error)
        return None
    remarks = examine(exercise)
    for line in _lines(exercise, remarks, file):
        # Do not wrap long lines: other programs read this, too.
        console.print(line, soft_wrap=True)
    return {remark.level for remark in remarks}


def _lines(exercise: Exercise, remarks: list[Remark], file: Path) -> Iterator[Text]:
    failed = any(remark.level is Level.FAILED for remark in remarks)
    verdict = (spoken(say("ok")), "green")
    if failed:
        verdict = (spoken(say("failed")), STYLES[Level.FAILED])
    yield Text.assemble((exercise.id, "bold"), ": ", verdict, f", {spoken(summary(exercise))}")
    lines = value_lines(file.read_text(encoding="utf-8")) if remarks else {}
    for remark in remarks:
        place = with_line(remark.field, line_of(remark.field, lines))
        told = spoken(joined(": ", [place, remark.text]))
        level = say("failed") if remark.level is Level.FAILED else say("warning")
        yield Text.assemble("  ", (spoken(level), STYLES[remark.level]), f": {told}")


def _summary(files: int, unusable: int, found: Counter[Level]) -> str:
    failed = found[Level.FAILED]
    warned = found[Level.WARNING]
    ok = say_count(
        "{count} exercise: {ok} ok",
        "{count} exercises: {ok} ok",
        count=files,
        ok=files - unusable - failed,
    )
    others = [
        say("{number} failed", number=failed) if failed else "",
        say("{number} cannot be used", number=unusable) if unusable else "",
        say("{number} with warnings", number=warned) if warned else "",
    ]
    return spoken(joined(", ", [ok, *filter(None, others)]))
