"""`dh-grader grade`: submissions in files, graded here and now."""

import io
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Final

import typer
from rich.console import Console

from service.catalogue import Exercise
from service.cli.submission_files import UnusableFileError, read_submission
from service.cli.terminal import UNUSABLE, complain, give_up, installed, stdout
from service.formats import FORMATS, GradedFile
from service.formats.text import visible
from service.grading import FeedbackLevel, UnknownPartError, grade
from service.submissions.lookup import find_exercise, nearest

BELOW_PASS_MARK = 1


def _known(name: str) -> str:
    if name not in FORMATS:
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(_NAMES)}.")
    return name


# Text is for people, so it comes first.
_NAMES: Final = sorted(FORMATS, key=lambda name: name != "text")


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
        str,
        typer.Option(
            "--format",
            metavar=f"<{'|'.join(_NAMES)}>",
            callback=_known,
            help="For people, or for programs: json prints exactly the report, and for several "
            'files a list with {"file", "report"} or {"file", "error"} for each.',
        ),
    ] = "text",
    output: Annotated[
        Path | None, typer.Option(metavar="F", help="Write to this file instead.")
    ] = None,
    pass_mark: Annotated[float, typer.Option(min=0, max=1, help="The score to reach, of 1.")] = 0.8,
    feedback: Annotated[
        FeedbackLevel | None,
        typer.Option(
            help="How much to tell: hints and corrections, what to look at, right and wrong, or "
            "bare marks. What could not be read is told in any case. By default what the file asks "
            "for, else full."
        ),
    ] = None,
    echo: Annotated[bool, typer.Option("--echo", help="Tell how each cell was read.")] = False,
) -> None:
    """Grade submissions: JSON or TOML files of the same shape as the HTTP body.

    Exit code 0: every file reaches the pass mark.

    Exit code 1: one is below it.

    Exit code 2: a file, exercise or part is unusable; other files are graded all the same.
    """
    chosen = _restricted(find_exercise(installed(), exercise), part)
    graded = [_graded(file, chosen, part, feedback, echo=echo) for file in files]
    for result in graded:
        if result.error:
            complain(f"{result.file}: {result.error}")
    console = stdout()
    if output is not None:
        page = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
        console = Console(file=page, width=80, highlight=False, markup=False)
    content = FORMATS[output_format].document(graded, console)
    if output is None:
        typer.echo(content, nl=False)
    else:
        _write(content, output)
    raise SystemExit(max(_exit_code(result, pass_mark) for result in graded))


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
    file: Path,
    exercise: Exercise,
    part: str | None,
    feedback: FeedbackLevel | None,
    *,
    echo: bool,
) -> GradedFile:
    """The file with its report: these are a tutor's own files, so nothing need be kept back."""
    try:
        submission = read_submission(file, part).submission(FeedbackLevel.FULL)
        feedback = submission.feedback if feedback is None else feedback
        submission = replace(submission, feedback=feedback, echo=echo or submission.echo)
        return GradedFile(file, grade(exercise, submission))
    except UnusableFileError as error:
        return GradedFile(file, None, str(error))
    except UnknownPartError as error:
        known = ", ".join(error.known)
        name = visible(error.unknown[:60])
        return GradedFile(file, None, f"answers {name!r}, but {exercise.id} has only {known}")


def _exit_code(result: GradedFile, pass_mark: float) -> int:
    if result.report is None:
        return UNUSABLE
    # Scores are rounded to six digits, so 1/3 passes a pass mark of 0.33333333.
    return 0 if result.report.score >= pass_mark - 5e-7 else BELOW_PASS_MARK


def _write(content: bytes, output: Path) -> None:
    try:
        output.write_bytes(content)
    except OSError as error:
        give_up(f"{output}: cannot be written: {error.strerror}")
