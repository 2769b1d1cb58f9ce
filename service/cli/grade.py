"""`dh-grader grade`: submissions in files, graded here and now."""

import io
import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Final

import typer
from rich.console import Console

from service.catalogue import Exercise
from service.cli.output_folder import UnusableFolderError, is_for_folder, write_folder
from service.cli.submission_files import UnusableFileError, read_submission
from service.cli.terminal import UNUSABLE, complain, give_up, installed, stdout
from service.formats import FORMAT_NAMES, report_format
from service.formats.shared.graded import GradedFile, GradedSubmission, Visibility, answered
from service.formats.shared.plain_text import visible
from service.formats.shared.report_format import Setting, UnusableSettingError
from service.grading import FeedbackLevel, Report, UnknownPartError, grade
from service.submissions.lookup import find_exercise, nearest

BELOW_PASS_MARK = 1


def _known(name: str) -> str:
    if name not in FORMAT_NAMES:
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(_NAMES)}.")
    return name


# Text is for people, so it comes first.
_NAMES: Final = sorted(FORMAT_NAMES, key=lambda name: name != "text")


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
            "--format", metavar="NAME", callback=_known, help=f"One of {', '.join(_NAMES)}."
        ),
    ] = "text",
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="F",
            help="Write to this file instead; html writes several submissions to a folder, with "
            "an overview of the class.",
        ),
    ] = None,
    pass_mark: Annotated[float, typer.Option(min=0, max=1, help="The score to reach, of 1.")] = 0.8,
    feedback: Annotated[
        FeedbackLevel | None,
        typer.Option(
            help="How much to tell: hints and corrections, what to look at, right and wrong, or "
            "bare marks. What could not be read is told in any case. By default what the file asks "
            "for, else full, or what the exercise allows in a format that students read."
        ),
    ] = None,
    echo: Annotated[bool, typer.Option("--echo", help="Tell how each cell was read.")] = False,
    visibility: Annotated[
        Visibility, typer.Option(help="When Gradescope shows the result to students.")
    ] = Visibility.VISIBLE,
) -> None:
    """Grade submissions: JSON or TOML files of the same shape as the HTTP body.

    Exit code 0: every file reaches the pass mark.

    Exit code 1: one is below it.

    Exit code 2: a file, exercise or part is unusable; other files are graded all the same.
    """
    chosen = _restricted(find_exercise(installed(), exercise), part)
    taken = report_format(output_format)
    if taken.is_single and len(files) > 1:
        give_up(
            f"{output_format} holds one submission, and {len(files)} files are given: grade them "
            "one by one, or take a format for several."
        )
    most = chosen.feedback if taken.for_students else FeedbackLevel.FULL
    told = answered(chosen)
    codes = [0]

    def submissions() -> Iterator[GradedSubmission]:
        for file in files:
            report, problem = _report(
                file, chosen, part, feedback, most, echo=echo or taken.shows_entries
            )
            if problem:
                complain(visible(f"{file}: {problem}"))
            graded = GradedFile(str(file), told, report, problem)
            submission = GradedSubmission(str(file), file.stem, (graded,), pass_mark)
            codes.append(_exit_code(submission))
            yield submission

    console = stdout()
    if output is not None:
        page = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
        console = Console(file=page, width=80, highlight=False, markup=False)
    setting = Setting((told,), console, datetime.now(UTC), os.environ, visibility)
    try:
        if output and taken.folder and is_for_folder(output, several=len(files) > 1):
            write_folder(taken.folder(submissions(), setting), output)
        else:
            _write(taken.pieces(submissions(), setting), output)
    except UnusableFolderError as error:
        give_up(f"{output}: {error}")
    except UnusableSettingError as error:
        give_up(f"{output_format}: {error}")
    raise SystemExit(max(codes))


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


def _report(
    file: Path,
    exercise: Exercise,
    part: str | None,
    feedback: FeedbackLevel | None,
    most: FeedbackLevel,
    *,
    echo: bool,
) -> tuple[Report | None, str]:
    """The report on the file, or the problem because of which there is none.

    The report tells what ``feedback`` asks for, else what the file asks for and ``most`` at the
    most: these are a tutor's own files, so nothing need be kept back.
    """
    try:
        submission = read_submission(file, part).submission(most)
        feedback = submission.feedback if feedback is None else feedback
        submission = replace(submission, feedback=feedback, echo=echo or submission.echo)
        return grade(exercise, submission), ""
    except UnusableFileError as error:
        return None, str(error)
    except UnknownPartError as error:
        known = ", ".join(error.known)
        return None, f"answers {error.unknown[:60]!r}, but {exercise.id} has only {known}"


def _exit_code(submission: GradedSubmission) -> int:
    if not submission.is_graded:
        return UNUSABLE
    return 0 if submission.passed else BELOW_PASS_MARK


def _write(pieces: Iterable[bytes], output: Path | None) -> None:
    """Write the pieces as they come; a file is there only when it is whole."""
    if output is None:
        for piece in pieces:
            typer.echo(piece, nl=False)
        return
    # A pipe or a device is no file to be replaced.
    is_replaced = output.is_file() or not output.exists()
    written = output.with_name(f".{output.name}.part") if is_replaced else output
    try:
        with written.open("wb") as file:
            file.writelines(pieces)
        if is_replaced:
            written.replace(output)
    except OSError as error:
        give_up(f"{output}: cannot be written: {error.strerror}")
    finally:
        if is_replaced:
            written.unlink(missing_ok=True)
