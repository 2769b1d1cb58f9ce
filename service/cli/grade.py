"""`dh-grader grade`: submissions in files, graded here and now."""

import io
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from service.catalogue import Exercise
from service.cli.submission_files import UnusableFileError, read_submission
from service.cli.terminal import UNUSABLE, complain, exercise_or_exit, give_up, stdout
from service.formats import FORMATS
from service.formats.text import visible
from service.grading import FeedbackLevel, Report, UnknownPartError, grade
from service.submissions import nearest

BELOW_PASS_MARK = 1


if TYPE_CHECKING:
    ReportFormat = StrEnum
else:
    # The format for people first, since it is the default.
    ReportFormat = StrEnum(
        "ReportFormat", {name: name for name in sorted(FORMATS, key=lambda name: name != "text")}
    )
_TEXT: Final = next(iter(ReportFormat))


def command(
    files: Annotated[list[Path], typer.Argument(metavar="FILE", show_default=False)],
    exercise: Annotated[
        str, typer.Option(metavar="ID", help="The exercise that is answered.", show_default=False)
    ],
    part: Annotated[
        str | None,
        typer.Option(metavar="P", help="Grade this part only; a file may hold its answer alone."),
    ] = None,
    output_format: Annotated[
        ReportFormat,
        typer.Option(
            "--format",
            help="For people, or for programs: json prints exactly the report, and for several "
            'files a list with {"file", "report"} or {"file", "error"} for each.',
        ),
    ] = _TEXT,
    output: Annotated[
        Path | None, typer.Option(metavar="F", help="Write to this file instead.")
    ] = None,
    pass_mark: Annotated[float, typer.Option(min=0, max=1, help="The score to reach, of 1.")] = 0.8,
    feedback: Annotated[
        FeedbackLevel | None,
        typer.Option(
            help="How much to tell: everything, all but the correction, or only marks and what "
            "could not be read. By default what the file asks for, else full."
        ),
    ] = None,
) -> None:
    """Grade submissions: JSON or TOML files of the same shape as the HTTP body.

    Exit code 0: every file reaches the pass mark.

    Exit code 1: one is below it.

    Exit code 2: a file, exercise or part is unusable; other files are graded all the same.
    """
    chosen = _restricted(exercise_or_exit(exercise), part)
    results = [(str(file), _graded(file, chosen, part, feedback)) for file in files]
    for name, result in results:
        if isinstance(result, str):
            complain(f"{name}: {result}")
    page = FORMATS[output_format.value]
    if output is None:
        typer.echo(page(results, stdout()), nl=False)
    else:
        console = Console(file=io.StringIO(), width=80, highlight=False, markup=False)
        _save(page(results, console), output)
    raise SystemExit(max(_exit_code(result, pass_mark) for _, result in results))


def _restricted(exercise: Exercise, part_id: str | None) -> Exercise:
    """The exercise with this part only, so that the score is the part's."""
    if part_id is None:
        return exercise
    part = exercise.part(part_id)
    if part is None:
        known = [part.id for part in exercise.parts]
        suggestion = nearest(part_id, known)
        hint = f" Did you mean {suggestion!r}?" if suggestion else ""
        give_up(f"{exercise.id} has no part {part_id!r}.{hint} Its parts are: {', '.join(known)}.")
    return replace(exercise, parts=(part,))


def _graded(
    file: Path, exercise: Exercise, part: str | None, feedback: FeedbackLevel | None
) -> Report | str:
    """The report on a file, or the reason why there is none."""
    try:
        submission = read_submission(file, part).submission()
        if feedback is not None:
            submission = replace(submission, feedback=feedback)
        return grade(exercise, submission)
    except UnusableFileError as error:
        return str(error)
    except UnknownPartError as error:
        known = ", ".join(error.known)
        name = visible(error.unknown[:60])
        return f"answers {name!r}, but {exercise.id} has only {known}"


def _exit_code(result: Report | str, pass_mark: float) -> int:
    if isinstance(result, str):
        return UNUSABLE
    # Scores are rounded to six digits, so 1/3 passes a pass mark of 0.33333333.
    return 0 if result.score >= pass_mark - 5e-7 else BELOW_PASS_MARK


def _save(content: bytes, output: Path) -> None:
    try:
        output.write_bytes(content)
    except OSError as error:
        give_up(f"{output}: cannot be written: {error.strerror}")
