"""`dh-grader grade`: submissions in files, graded here and now."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from service.cli.choices import choice, listed, one_of
from service.cli.files.output import console_of, write
from service.cli.files.output_folder import UnusableFolderError, is_for_folder, write_folder
from service.cli.files.written_files import remember, require_own
from service.cli.remote.server import (
    REQUESTS,
    graded_by,
    require_no_own_files,
    server_of,
    set_exercise,
)
from service.cli.running.interrupts import interruptible
from service.cli.running.processes import WorkerLostError, jobs_for, mapped
from service.cli.running.progress import Progress, progress
from service.cli.terminal import UNUSABLE, complain, give_up
from service.formats import FORMAT_NAMES, report_format
from service.formats.shared.graded import GradedSubmission, Visibility
from service.formats.shared.plain_text import visible
from service.formats.shared.report_format import Setting, UnusableSettingError
from service.grading import FeedbackLevel
from service.local_grading import GradingTerms, graded
from service.settings import Settings, load_settings
from service.submissions.assignment import (
    Assignment,
    UnknownPartNameError,
    load_assignment,
    of_one,
)
from service.submissions.handed_in import HandedIn, all_handed_in
from service.submissions.outline import SetExercise

if TYPE_CHECKING:
    from service.client import GraderClient

BELOW_PASS_MARK = 1

commands = typer.Typer(add_completion=False)


# Text is for people, so it comes first.
_NAMES: Final = sorted(FORMAT_NAMES, key=lambda name: name != "text")


@commands.command("grade")
def command(
    context: typer.Context,
    paths: Annotated[
        list[Path],
        typer.Argument(
            metavar="PATH",
            show_default=False,
            help="Files, folders of a class, or - for standard input. In a folder each file is the "
            "submission of one student, and so is each folder with its files.",
        ),
    ],
    exercise: Annotated[
        str | None,
        typer.Option(metavar="ID", help="The exercise that is answered.", show_default=False),
    ] = None,
    assignment: Annotated[
        Path | None,
        typer.Option(
            metavar="F", help="Several exercises instead, in an assignment file.", exists=False
        ),
    ] = None,
    part: Annotated[
        str | None,
        typer.Option(
            metavar="P",
            help="Grade this part of the exercise only; a file may hold its answer alone.",
        ),
    ] = None,
    one_student: Annotated[
        bool,
        typer.Option(
            "--one-student",
            help="A folder holds the files of one student. So it is in formats for one submission.",
        ),
    ] = False,
    output_format: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="NAME",
            callback=lambda name: one_of(name, _NAMES),
            help=f"One of {', '.join(_NAMES)}.",
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
    pass_mark: Annotated[
        float | None,
        typer.Option(
            min=0,
            max=1,
            help="The score to reach, of 1. By default that of the assignment, or 0.8.",
            show_default=False,
        ),
    ] = None,
    feedback: Annotated[
        FeedbackLevel | None,
        typer.Option(
            parser=choice(FeedbackLevel),
            metavar=listed(FeedbackLevel),
            help="How much to tell: hints and corrections, what to look at, right and wrong, or "
            "bare marks. What could not be read is told in any case. By default what the file asks "
            "for, else full, or what the exercise allows in a format that students read.",
        ),
    ] = None,
    echo: Annotated[bool, typer.Option("--echo", help="Tell how each cell was read.")] = False,
    jobs: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=256,
            help="How many processes grade, by default as many as there are cores, where there are "
            f"many submissions; or how many requests a server has at once, by default {REQUESTS}.",
            show_default=False,
        ),
    ] = None,
    server: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            help="Have this service grade, by its exercises; DH_GRADER_SERVER says the same.",
            show_default=False,
        ),
    ] = None,
    key: Annotated[
        str | None,
        typer.Option(
            metavar="KEY",
            help="The key for it. Rather set DH_GRADER_KEY: others may see a command line.",
            show_default=False,
        ),
    ] = None,
    visibility: Annotated[
        Visibility,
        typer.Option(
            parser=choice(Visibility),
            metavar=listed(Visibility),
            help="When Gradescope shows the result to students.",
        ),
    ] = Visibility.VISIBLE,
) -> None:
    """Grade submissions: JSON, TOML, or the pasted answer to one part (csv, md, tex, m, py, …).

    Exit code 0: every submission reaches the pass mark.

    Exit code 1: one is below it.

    Exit code 2: a file, exercise or part is unusable; other files are graded all the same.
    """
    settings = load_settings(server=server, key=key)
    if key is not None and settings.server is None:
        give_up("--key goes with --server URL.")
    grader = context.with_resource(server_of(settings))
    chosen = chosen_assignment(exercise, assignment, part, partial(set_exercise, server=grader))
    if grader is not None:
        require_no_own_files(chosen)
    taken = report_format(output_format)
    if taken.is_single and len(paths) > 1:
        give_up(
            f"{output_format} holds one submission, and {len(paths)} files are given: grade them "
            "one by one, or take a format for several."
        )
    folders = [path for path in paths if path.is_dir()]
    if output is not None:
        _keep(output, [*paths, *filter(None, [assignment])])
        require_own(output, folders)
    terms = GradingTerms(
        chosen,
        chosen.pass_mark if pass_mark is None else pass_mark,
        feedback,
        for_students=taken.for_students,
        echo=echo or taken.shows_entries,
    )
    found = list(
        all_handed_in(
            paths,
            folder_is_one=one_student or taken.is_single,
            left_out=output,
            parts=chosen.part_names,
        )
    )
    if not found:
        give_up(f"{', '.join(map(str, paths))}: holds no submission")
    is_class = bool(folders) and not one_student
    setting = Setting(terms.answered, console_of(output), datetime.now(UTC), os.environ, visibility)
    try:
        with (
            interruptible() as check,
            progress(len(found)) as shown,
            _grading(grader, terms, found, jobs, output, settings) as all_graded,
        ):
            run = _Run(all_graded, shown, check)
            several = is_class or len(found) > 1
            if output and taken.folder and is_for_folder(output, several=several):
                write_folder(taken.folder(run.submissions(), setting), output)
            else:
                pieces = taken.pieces(run.submissions(), setting)
                write(pieces, output, at_once=shown.is_shown or not taken.is_stream)
            remember(output, folders)
    except UnusableFolderError as error:
        give_up(f"{output}: {error}")
    except UnusableSettingError as error:
        give_up(f"{output_format}: {error}")
    except WorkerLostError:
        give_up("A process that grades has been ended from outside; try again with fewer --jobs.")
    _explain_one_student(output_format, () if one_student else folders, run.exit_code)
    raise SystemExit(run.exit_code)


def chosen_assignment(
    exercise: str | None, file: Path | None, part: str | None, find: Callable[[str], SetExercise]
) -> Assignment:
    """The exercise, a part of it or an assignment, as the options name it; or give up."""
    if (exercise is None) == (file is None):
        give_up("Name what is answered: --exercise ID, or --assignment F instead.")
    if file is not None:
        if part is not None:
            give_up("--part goes with --exercise; an assignment says itself which parts are set.")
        return load_assignment(file, find)
    try:
        return of_one(find(exercise or ""), part)
    except UnknownPartNameError as error:
        give_up(str(error))


def _keep(output: Path, read: Iterable[Path]) -> None:
    """Give up where the output would take the place of a file that is read."""
    for path in read:
        if path.is_file() and output.exists() and path.samefile(output):
            give_up(f"{output}: is read, and would be overwritten; name another --output")


def _explain_one_student(output_format: str, folders: Sequence[Path], exit_code: int) -> None:
    """Tell who graded a class in a format for one submission why that went wrong."""
    if folders and exit_code == UNUSABLE and report_format(output_format).is_single:
        complain(
            f"{output_format} holds one submission, so the folder {folders[0]} was taken for that "
            "of one student; for a class take another --format, such as csv or html."
        )


def _grading(
    server: "GraderClient | None",
    terms: GradingTerms,
    found: Sequence[HandedIn],
    jobs: int | None,
    output: Path | None,
    settings: Settings,
) -> AbstractContextManager[Iterator[GradedSubmission]]:
    """The submissions in order as they are graded, by the server or else here."""
    if server is not None:
        return graded_by(server, terms, found, jobs or REQUESTS, output, settings)
    jobs = min(jobs or jobs_for(len(found)), len(found))
    return mapped(partial(graded, terms=terms), found, jobs)


class _Run:
    """The submissions as they are graded; ``exit_code`` is that of the worst so far.

    ``check`` is called between them, and may end the run.
    """

    def __init__(
        self,
        submissions: Iterable[GradedSubmission],
        shown: Progress,
        check: Callable[[], None],
    ) -> None:
        self._submissions = submissions
        self._shown = shown
        self._check = check
        self.exit_code = 0

    def submissions(self) -> Iterator[GradedSubmission]:
        for submission in self._submissions:
            self._check()
            for told in _complaints(submission):
                self._shown.complain(told)
            self.exit_code = max(self.exit_code, _exit_code(submission))
            yield submission
            self._shown.advance()


def _complaints(submission: GradedSubmission) -> list[str]:
    """The problems of its files, each once: one file may leave several exercises unanswered."""
    told = (f"{file.file}: {file.problem}" for file in submission.files if file.problem)
    return [visible(line) for line in dict.fromkeys(told)]


def _exit_code(submission: GradedSubmission) -> int:
    if any(file.problem for file in submission.files):
        return UNUSABLE
    return 0 if submission.passed else BELOW_PASS_MARK
