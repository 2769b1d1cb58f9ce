"""`dh-grader grade` and `merge`: grade submissions in files, and write their reports.

No file of a student is ever overwritten, and no output is left half written.
"""

import io
import json
import os
import secrets
import shutil
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence, Set
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import KW_ONLY, dataclass, replace
from datetime import UTC, datetime
from functools import partial
from itertools import count
from pathlib import Path, PurePosixPath
from tempfile import SpooledTemporaryFile
from typing import TYPE_CHECKING, Annotated, Final

import typer
from rich.console import Console

from dh_grader.catalogue import load_exercise, read_regular
from dh_grader.cli.options import choice, listed, one_of, own_file, report_language
from dh_grader.cli.remote import REQUESTS, graded_by, require_no_own_files, server_of, set_exercise
from dh_grader.cli.running import (
    Shard,
    UnusableShardsError,
    WorkerLostError,
    jobs_for,
    mapped,
    merged,
    shard_of,
    with_header,
)
from dh_grader.cli.terminal import (
    BELOW_PASS_MARK,
    UNUSABLE,
    Progress,
    complain,
    give_up,
    interruptible,
    progress,
    spoken,
    stdout,
    unreadable,
    unwritable,
)
from dh_grader.formats import FORMAT_NAMES, report_format
from dh_grader.formats.class_page import WRITTEN, feedback_zip, is_earlier_output, is_output
from dh_grader.formats.documents import comment
from dh_grader.formats.graded import (
    Document,
    GradedSubmission,
    GradingTerms,
    ReportFormat,
    Setting,
    UnusableSettingError,
    Visibility,
    graded,
)
from dh_grader.formats.texts import visible
from dh_grader.formats.worksheets import (
    MAX_WORKSHEET,
    Grade,
    UnusableWorksheetError,
    Worksheet,
    grade_of,
)
from dh_grader.grading import FeedbackLevel
from dh_grader.settings import Settings, load_settings
from dh_grader.submissions import (
    Assignment,
    SetExercise,
    UnknownPartNameError,
    load_assignment,
    of_one,
    with_seeds,
)
from dh_grader.submissions.answers import of_file
from dh_grader.submissions.files import HandedIn, UnusableClassError, all_handed_in
from dh_grader.translations import Language, Sentence, joined, reason_of, say, say_count
from dh_grader.variants import NoVariantError

if TYPE_CHECKING:
    from dh_grader.client import GraderClient


# --- `dh-grader grade`: grade submissions in files


grade_commands = typer.Typer(add_completion=False)


# The most earlier outputs that one sentence names.
_MOST_NAMED: Final = 10
# The most files without a part that are named.
_MOST_WITHOUT_PART: Final = 3
# The format for people comes first.
_NAMES: Final = sorted(FORMAT_NAMES, key=lambda name: name != "text")


@grade_commands.command("grade")
def grade_command(
    context: typer.Context,
    paths: Annotated[
        list[Path],
        typer.Argument(
            metavar="PATH",
            show_default=False,
            help="Files, folders of a class, or - for standard input. In a folder, each file and "
            "each subfolder is the submission of one student.",
        ),
    ],
    exercise: Annotated[
        str | None,
        typer.Option(
            metavar="ID|FILE",
            help="The exercise to grade: its id, or an exercise file (….toml).",
            show_default=False,
        ),
    ] = None,
    assignment: Annotated[
        Path | None,
        typer.Option(metavar="F", help="An assignment file with several exercises.", exists=False),
    ] = None,
    part: Annotated[
        str | None,
        typer.Option(
            metavar="P",
            help="Grade only this part of the exercise; a file may contain just its answer.",
        ),
    ] = None,
    one_student: Annotated[
        bool,
        typer.Option(
            "--one-student",
            help="The folder holds the files of one student. Formats for one submission imply "
            "this.",
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
            help="Write to this file; html writes several submissions into a folder, with an "
            "overview of the class, or, if F ends in .zip, into a zip file of feedback for Moodle.",
        ),
    ] = None,
    worksheet: Annotated[
        Path | None,
        typer.Option(
            metavar="F",
            help="The grading worksheet of Moodle, or the gradebook of Canvas, Brightspace or "
            "Blackboard. Grades and comments go into a copy, F-graded.csv, and all else stays as "
            "it is.",
            exists=False,
        ),
    ] = None,
    column: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="The column of the gradebook that --worksheet fills, if there are several: its "
            "heading, or the beginning of it.",
            show_default=False,
        ),
    ] = None,
    replace_grades: Annotated[
        bool,
        typer.Option(
            "--replace-grades",
            help="Replace grades and comments that are already in the worksheet. Otherwise they "
            "stay.",
        ),
    ] = False,
    force: Annotated[
        bool,
        typer.Option(
            "--force",
            help="Let --output and --worksheet replace an existing file that is no earlier report.",
        ),
    ] = False,
    pass_mark: Annotated[
        float | None,
        typer.Option(
            min=0,
            max=1,
            help="The score to pass, from 0 to 1. By default that of the assignment, or 0.8.",
            show_default=False,
        ),
    ] = None,
    feedback: Annotated[
        FeedbackLevel | None,
        typer.Option(
            parser=choice(FeedbackLevel),
            metavar=listed(FeedbackLevel),
            help="How much feedback to give: hints and corrections, hints, verdicts, or only "
            "marks. Unreadable entries are always named. By default the level in the file, "
            "otherwise full; in formats for students, the level of the exercise.",
        ),
    ] = None,
    language: Annotated[
        str | None,
        typer.Option(
            "--lang",
            metavar="CODE",
            help="The language of the report: en, de, es, fr or zh. Also: DH_GRADER_LANGUAGE.",
            show_default=False,
        ),
    ] = None,
    echo: Annotated[bool, typer.Option("--echo", help="Show how each cell was read.")] = False,
    jobs: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=256,
            help="The number of processes, by default up to the number of cores; with --server, "
            f"the number of concurrent requests, by default {REQUESTS}.",
            show_default=False,
        ),
    ] = None,
    server: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            help="Let this server grade with its exercises. Also: DH_GRADER_SERVER.",
            show_default=False,
        ),
    ] = None,
    key: Annotated[
        str | None,
        typer.Option(
            metavar="KEY",
            help="The key for the server. Better set DH_GRADER_KEY: others may see your command "
            "line.",
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
    shard: Annotated[
        Shard | None,
        typer.Option(
            parser=shard_of,
            metavar="K/N",
            help="Grade only the K-th of N shards of the submissions, as jsonl. `dh-grader merge` "
            "puts the shards together.",
            show_default=False,
        ),
    ] = None,
    platform_data: Annotated[Path | None, typer.Option(hidden=True)] = None,
    variants: Annotated[Path | None, typer.Option(hidden=True)] = None,
    quiet: Annotated[
        bool,
        typer.Option(
            "--quiet",
            "-q",
            help="Print no report and no progress bar, only problems. The exit code and --output "
            "stay the same.",
        ),
    ] = False,
) -> None:
    """Grade submissions: JSON, TOML, or the pasted answer to one part (csv, md, tex, m, py, …).

    Exit code 0: every submission reaches the pass mark.

    Exit code 1: a submission is below the pass mark.

    Exit code 2: a file, exercise or part is unusable; the other files are still graded.
    """
    settings = load_settings(server=server, key=key, language=language)
    if key is not None and settings.server is None:
        give_up(say("--key goes with --server URL."))
    grader = context.with_resource(server_of(settings))
    chosen = chosen_assignment(exercise, assignment, part, partial(set_exercise, server=grader))
    if grader is not None:
        require_no_own_files(chosen)
    chosen = _variants_of_student(chosen, platform_data, variants)
    taken = _format(output_format, paths, shard)
    sheet = _worksheet(worksheet, column, shard)
    folders = [path for path in paths if path.is_dir()]
    if output is not None:
        require_no_input(output, [*paths, *filter(None, [assignment, worksheet])])
        require_own(output, folders, force=force)
    terms = GradingTerms(
        chosen,
        chosen.pass_mark if pass_mark is None else pass_mark,
        feedback,
        for_students=taken.for_students,
        echo=echo or taken.shows_entries,
        language=report_language(settings, output_format),
    )
    found, left_out = _found(
        paths,
        folder_is_one=one_student or taken.is_single,
        # They may be in the folder of the class.
        own=[*filter(None, [output, worksheet])],
        parts=chosen.part_names,
        sheet=sheet,
    )
    own = found if shard is None else shard.of(found)
    is_class = bool(folders) and not one_student
    setting = Setting(
        terms.answered,
        console_of(output),
        datetime.now(UTC),
        os.environ,
        visibility,
        terms.language,
        left_out=left_out,
    )
    try:
        with (
            interruptible() as check,
            progress(0 if quiet else len(own)) as shown,
            _grading(grader, terms, own, jobs, output, settings) as all_graded,
        ):
            run = _GradeRun(all_graded, shown, check, terms.language, has_worksheet=bool(sheet))
            several = is_class or len(found) > 1
            if output and taken.folder and is_for_folder(output, several=several):
                in_folder = replace(setting, folder=output)
                write_folder(taken.folder(run.submissions(), in_folder), output)
            else:
                pieces = _pieces(taken, output)(run.submissions(), setting)
                if shard is not None:
                    names = [each.name for each in found]
                    pieces = with_header(pieces, shard, names, [it.id for it in terms.answered])
                at_once = shown.is_shown or not taken.is_stream
                write(pieces, output, at_once=at_once, quiet=quiet)
            remember(output, folders)
        if sheet and worksheet:
            filling = _Filling(
                sheet,
                worksheet,
                replaces=replace_grades,
                force=force,
                quiet=quiet,
                language=None if language is None else terms.language,
            )
            run.exit_code = max(run.exit_code, filling.fill(run.grades))
    except UnusableFolderError as error:
        give_up(joined(": ", [str(output), error.args[0]]))
    except UnusableSettingError as error:
        give_up(joined(": ", [output_format, error.args[0]]))
    except WorkerLostError:
        give_up(say("A grading process was killed, perhaps for lack of memory; try fewer --jobs."))
    _explain_one_student(output_format, () if one_student else folders, run.exit_code)
    raise SystemExit(run.exit_code)


def chosen_assignment(
    exercise: str | None, file: Path | None, part: str | None, find: Callable[[str], SetExercise]
) -> Assignment:
    """Return the assignment that the options name; exit if the options contradict each other."""
    if (exercise is None) == (file is None):
        give_up(say("Name what is answered: --exercise ID or FILE, or --assignment F instead."))
    if file is not None:
        if part is not None:
            give_up(
                say("--part goes with --exercise; an assignment says itself which parts are set.")
            )
        return load_assignment(file, find)
    name = exercise or ""
    own = own_file(name)
    try:
        return of_one(find(name) if own is None else load_exercise(own), part, own)
    except UnknownPartNameError as error:
        give_up(error)


def _variants_of_student(
    assignment: Assignment, platform_data: Path | None, variants: Path | None
) -> Assignment:
    # The scripts of bundles pass the platform's file about the student as ``platform_data``, and
    # the file with the secret as ``variants``.
    if not assignment.variants:
        return assignment
    # Few runs need it.
    from dh_grader.bundles import UnknownStudentError, platform_seeds

    if platform_data is None:
        give_up(
            say(
                "Each student has variants of their own in this assignment. Grade it in a course "
                "or by a bundle, or name a single variant: --exercise ID~SEED."
            )
        )
    try:
        return with_seeds(assignment, platform_seeds(platform_data, variants))
    except (UnknownStudentError, NoVariantError) as error:
        give_up(error)


def _format(name: str, paths: Sequence[Path], shard: Shard | None) -> ReportFormat:
    taken = report_format(name)
    if taken.is_single and len(paths) > 1:
        give_up(
            say(
                "{format} holds one submission, and {files} files are given: grade them one by "
                "one, or take a format for several.",
                format=name,
                files=len(paths),
            )
        )
    if shard is not None and name != "jsonl":
        give_up(say("--shard writes shards as JSON lines: add --format jsonl."))
    return taken


def _worksheet(file: Path | None, column: str | None, shard: Shard | None) -> Worksheet | None:
    if file is None:
        return None
    if shard is not None:
        give_up(say("--worksheet needs all submissions, and --shard grades some of them."))
    try:
        return Worksheet(read_regular(file, MAX_WORKSHEET), column)
    except UnusableWorksheetError as error:
        give_up(of_file(str(file), error.args[0]))
    except OSError as error:
        give_up(unreadable(file, error))


@dataclass(frozen=True, slots=True)
class _Filling:
    # Fills the worksheet of a platform, and says what was done.

    sheet: Worksheet
    file: Path
    _: KW_ONLY
    replaces: bool
    force: bool
    quiet: bool
    # The language that the tutor chose for the report, if any.
    language: Language | None = None

    def fill(self, grades: Iterable[Grade]) -> int:
        """Write the filled worksheet; return the exit code."""
        filled = self.sheet.filled(grades, replaces=self.replaces)
        for problem in filled.problems:
            self._complain(problem)
        if filled.kept:
            self._complain(
                say(
                    "To replace all these grades, add --replace-grades. To replace only some, "
                    "empty their cells in the worksheet."
                )
            )
        if filled.content == self.sheet.content:
            self._complain(
                say("{file}: no grade was filled in; no file is written", file=str(self.file))
            )
            return UNUSABLE if filled.is_foreign else 0
        target, others = self._target(filled.content)
        write([filled.content], target, at_once=True)
        if others:
            names = ", ".join(map(str, others))
            self._complain(
                say(
                    "This file exists with other contents, and stays as it is: {files}", files=names
                )
            )
        if others or not self.quiet:
            self._complain(
                say(
                    "{file} is written. Grades filled in: {count}. Already the same: {same}. "
                    "Left for grading by hand: {left}.",
                    file=str(target),
                    count=filled.grades,
                    same=filled.same,
                    left=filled.by_hand,
                )
            )
        return 0

    def _complain(self, sentence: str) -> None:
        complain(sentence, self.language)

    def _target(self, content: bytes) -> tuple[Path, list[Path]]:
        # A tutor may have changed an earlier file, so that only an equal one is replaced.
        others: list[Path] = []
        for target in _filled_names(self.file):
            if self.force or not target.exists() or _is_file_with(target, content):
                return target, others
            others.append(target)
        raise AssertionError  # There is no end of names.


def _is_file_with(path: Path, content: bytes) -> bool:
    try:
        return path.stat().st_size == len(content) and path.read_bytes() == content
    except OSError:
        return False


def _filled_names(worksheet: Path) -> Iterator[Path]:
    for i in count(1):
        number = "" if i == 1 else f"-{i}"
        yield worksheet.with_name(f"{worksheet.stem}-graded{number}{worksheet.suffix}")


def _found(
    paths: Sequence[Path],
    *,
    folder_is_one: bool,
    own: Sequence[Path],
    parts: Collection[str],
    sheet: Worksheet | None,
) -> tuple[list[HandedIn], tuple[str, ...]]:
    # The submissions, and the paths of earlier outputs between them.
    written = written_in(path for path in paths if path.is_dir())
    outputs: list[str] = []
    try:
        found = list(
            all_handed_in(
                paths,
                folder_is_one=folder_is_one,
                left_out=[*own, *written],
                parts=parts,
                is_output=is_output,
                outputs=outputs,
            )
        )
    except UnusableClassError as error:
        give_up(error)
    of_this_run = {path.resolve() for path in own}
    left_out = [str(path) for path in written if path.resolve() not in of_this_run]
    left_out += outputs
    if left_out:
        complain(
            say_count(
                "{count} entry is an earlier output or a worksheet, and is left out: {files}",
                "{count} entries are earlier outputs or worksheets, and are left out: {files}",
                count=len(left_out),
                files=", ".join(map(visible, left_out[:_MOST_NAMED]))
                + (", …" if len(left_out) > _MOST_NAMED else ""),
            )
        )
    if not found:
        give_up(say("{paths}: no submission was found", paths=", ".join(map(str, paths))))
    if sheet is not None:
        found = [
            replace(each, person=sheet.person(each.name, each.learner) or each.person)
            for each in found
        ]
    return found, tuple(left_out)


def _pieces(
    taken: ReportFormat, output: Path | None
) -> Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]:
    if taken.folder and output and output.suffix.lower() == ".zip":
        return partial(feedback_zip, page=taken.pieces)
    return taken.pieces


def _explain_one_student(output_format: str, folders: Sequence[Path], exit_code: int) -> None:
    if folders and exit_code == UNUSABLE and report_format(output_format).is_single:
        complain(
            say(
                "{format} holds one submission, so the folder {folder} was taken for that of one "
                "student; for a class take another --format, such as csv or html.",
                format=output_format,
                folder=str(folders[0]),
            )
        )


def _grading(
    server: "GraderClient | None",
    terms: GradingTerms,
    found: Sequence[HandedIn],
    jobs: int | None,
    output: Path | None,
    settings: Settings,
) -> AbstractContextManager[Iterator[GradedSubmission]]:
    if server is not None:
        return graded_by(server, terms, found, jobs or REQUESTS, output, settings)
    jobs = max(1, min(jobs or jobs_for(len(found)), len(found)))
    return mapped(partial(graded, terms=terms), found, jobs)


class _GradeRun:
    def __init__(
        self,
        submissions: Iterable[GradedSubmission],
        shown: Progress,
        check: Callable[[], None],
        language: Language,
        *,
        has_worksheet: bool,
    ) -> None:
        # With ``has_worksheet``, the grades are kept.
        self._submissions = submissions
        self._shown = shown
        self._check = check
        self._language = language
        self._has_worksheet = has_worksheet
        self.exit_code = 0
        self._without_part = 0
        self.grades: list[Grade] = []

    def submissions(self) -> Iterator[GradedSubmission]:
        for submission in self._submissions:
            self._check()
            for told in _complaints(submission):
                self._complain(told)
            self.exit_code = max(self.exit_code, _exit_code(submission))
            if self._has_worksheet:
                self.grades.append(grade_of(submission, comment(submission, self._language)))
            yield submission
            self._shown.advance()
        if (more := self._without_part - _MOST_WITHOUT_PART) > 0:
            self._shown.complain(spoken(_more_without_part(more)))

    def _complain(self, told: str) -> None:
        # Without --part, all files of a class may have this problem.
        self._without_part += "--part" in told
        if "--part" not in told or self._without_part <= _MOST_WITHOUT_PART:
            self._shown.complain(told)


def _more_without_part(count: int) -> Sentence:
    return say_count(
        "{count} other file has the same problem: name the part with --part.",
        "{count} other files have the same problem: name the part with --part.",
        count=count,
    )


def _complaints(submission: GradedSubmission) -> list[str]:
    reasons = ((file.file, file.by_hand) for file in submission.files if file.by_hand)
    beside = (
        (file.file, say("Graded, but without this file: {reason}", reason=each))
        for file in submission.files
        for each in file.beside
    )
    told = ((path, spoken(reason)) for path, reason in (*reasons, *beside))
    # A problem begins with the name of its file; that of a file in a folder gets its path.
    lines = (said if said.startswith(path) else f"{path}: {said}" for path, said in told)
    return [visible(line) for line in dict.fromkeys(lines)]


def _exit_code(submission: GradedSubmission) -> int:
    if any(file.problem for file in submission.files):
        return UNUSABLE
    return 0 if submission.passed else BELOW_PASS_MARK


# --- `dh-grader merge`: combine results of a class that several machines have graded


merge_commands = typer.Typer(add_completion=False)


@merge_commands.command("merge")
def merge_command(
    shards: Annotated[
        list[Path],
        typer.Argument(
            metavar="SHARD",
            show_default=False,
            help="The files of all shards, in any order.",
        ),
    ],
    output: Annotated[
        Path | None, typer.Option(metavar="F", help="Write to this file.", show_default=False)
    ] = None,
    force: Annotated[
        bool,
        typer.Option(
            "--force", help="Let --output replace an existing file that is no earlier report."
        ),
    ] = False,
) -> None:
    """Merge the shards that `grade --shard` has written into the JSON lines of one run.

    The lines and the exit code are the same as without --shard.
    """
    if output is not None:
        require_no_input(output, shards)
        require_own(output, [], force=force)
    run = _MergeRun(merged(shards))
    try:
        write(run.lines(), output, at_once=True)
    except UnusableShardsError as error:
        give_up(error)
    raise SystemExit(run.exit_code)


class _MergeRun:
    def __init__(self, lines: Iterable[bytes]) -> None:
        self._lines = lines
        self.exit_code = 0

    def lines(self) -> Iterator[bytes]:
        for line in self._lines:
            entry = json.loads(line)
            if "error" in entry:
                self.exit_code = UNUSABLE
            elif not entry["passed"]:
                self.exit_code = max(self.exit_code, BELOW_PASS_MARK)
            yield line


# --- Write reports to the screen, or to a file that appears only when it is complete


# Larger documents are buffered on the disk (bytes).
_IN_MEMORY: Final = 1024 * 1024


def console_of(output: Path | None) -> Console:
    """Return the console that lays out reports; a file has 80 columns and no colour."""
    if output is None:
        return stdout()
    page = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    return Console(file=page, width=80, highlight=False, markup=False)


def write(
    pieces: Iterable[bytes], output: Path | None, *, at_once: bool, quiet: bool = False
) -> None:
    """Write the pieces to the file ``output``, or to the screen if ``output`` is None.

    With ``at_once``, the screen shows all pieces at the end. A file appears only when it is
    complete, and a pipe never gets an incomplete document.
    """
    if output is not None:
        _write_file(pieces, output)
    elif quiet:
        for _ in pieces:
            pass
    elif at_once:
        with SpooledTemporaryFile(_IN_MEMORY) as whole:
            whole.writelines(pieces)
            whole.seek(0)
            _show(iter(lambda: whole.read(_IN_MEMORY), b""))
    else:
        _show(pieces)


def _show(pieces: Iterable[bytes]) -> None:
    for piece in pieces:
        typer.echo(piece, nl=False)


def _write_file(pieces: Iterable[bytes], output: Path) -> None:
    # A pipe or a device cannot be replaced: write to it directly.
    is_replaced = output.is_file() or not output.exists()
    written = output.with_name(f".{output.name}.part") if is_replaced else output
    try:
        with written.open("wb") as file:
            file.writelines(pieces)
        if is_replaced:
            written.replace(output)
    except OSError as error:
        give_up(unwritable(output, error))
    finally:
        if is_replaced:
            # After a failure the file may be missing, or its folder is not a folder.
            with suppress(OSError):
                written.unlink()


# --- Write a folder of documents completely or not at all


# The name of a folder that is still being written begins with this.
_UNFINISHED: Final = ".dh-grader-unfinished-"
_OLD: Final = "old"
# A file with one of these endings holds all pages.
_ONE_FILE: Final = (".html", ".htm", ".zip")


class UnusableFolderError(Exception):
    """Documents cannot be written into the folder; the message says why."""


def is_for_folder(output: Path, *, several: bool) -> bool:
    """True if reports go into a folder, False if they go into a single file.

    A new ``output`` becomes a folder if there are several submissions, unless its name ends like an
    HTML or zip file.
    """
    if output.exists():
        return output.is_dir()
    return several and output.suffix.lower() not in _ONE_FILE


def write_folder(documents: Iterable[Document], folder: Path) -> None:
    """Write all documents into the folder, or none. Raises UnusableFolderError.

    An existing folder must be empty, or contain only documents of an earlier run.
    """
    try:
        _write_all(documents, folder.resolve())
    except OSError as error:
        raise UnusableFolderError(
            say("cannot be written: {reason}", reason=reason_of(error))
        ) from error


def _write_all(documents: Iterable[Document], folder: Path) -> None:
    if not folder.exists():
        with _unfinished(folder.parent) as written:
            _write(documents, written)
            written.rename(folder)
        return
    old = _replaceable(folder)
    # Write inside the folder: it may be a mount point, into which nothing outside can be renamed.
    with _unfinished(folder) as written:
        _write(documents, written)
        _exchange(folder, written, old)


@contextmanager
def _unfinished(parent: Path) -> Iterator[Path]:
    folder = parent / f"{_UNFINISHED}{secrets.token_hex(8)}"
    folder.mkdir()
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _write(documents: Iterable[Document], folder: Path) -> None:
    paths = []
    for document in documents:
        file = folder / _within(document.path)
        file.parent.mkdir(exist_ok=True)
        with file.open("xb") as opened:
            opened.writelines(document.pieces)
        paths.append(f"{document.path}\n")
    (folder / WRITTEN).write_text("".join(paths), encoding="utf-8")


def _within(path: str) -> PurePosixPath:
    within = PurePosixPath(path)
    if within.is_absolute() or len(within.parts) > 2 or ".." in within.parts or "\n" in path:
        raise ValueError(f"{path!r} does not stay in its folder")
    return within


def _replaceable(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise UnusableFolderError(say("is no folder"))
    found = [path for path in folder.iterdir() if not path.name.startswith(_UNFINISHED)]
    for path in _foreign(found, _written_before(folder)):
        raise UnusableFolderError(
            say(
                "holds {name!r}, which no earlier run has written; name an empty folder, or "
                "one that does not exist",
                name=path.relative_to(folder).as_posix(),
            )
        )
    return found


def _written_before(folder: Path) -> set[Path]:
    try:
        paths = (folder / WRITTEN).read_text(encoding="utf-8").splitlines()
    except (FileNotFoundError, UnicodeDecodeError):
        return set()
    return {folder / path for path in (WRITTEN, *paths)}


def _foreign(found: Iterable[Path], written: Set[Path]) -> Iterator[Path]:
    # ``written`` are the files of earlier runs. The files in the folders are also checked.
    folders = {file.parent for file in written}
    for path in found:
        if path.is_symlink() or path not in (written if path.is_file() else folders):
            yield path
        elif path.is_dir():
            yield from (each for each in path.iterdir() if each.is_symlink() or each not in written)


def _exchange(folder: Path, written: Path, old: Iterable[Path]) -> None:
    new = list(written.iterdir())
    aside = written / _OLD
    aside.mkdir()
    moves = [*((path, aside / path.name) for path in old)]
    moves += [(path, folder / path.name) for path in new]
    done: list[tuple[Path, Path]] = []
    try:
        for source, target in moves:
            source.rename(target)
            done.append((source, target))
    except BaseException:
        for source, target in reversed(done):
            target.rename(source)
        raise


# --- Remember which files earlier runs have written, to protect the files of students


def require_no_input(output: Path, read: Iterable[Path]) -> None:
    """Exit if the output file would replace an input file."""
    for path in read:
        if path.is_file() and output.exists() and path.samefile(output):
            give_up(
                say(
                    "{file} is read, and would be overwritten; name another --output",
                    file=str(output),
                )
            )


def require_own(output: Path, folders: Iterable[Path], *, force: bool = False) -> None:
    """Exit with code 2 if the output would replace a file that is no earlier output.

    With ``force``, the output may replace any file that is not among the submissions.
    """
    if not output.is_file() or output.name in _written(output):
        return
    try:
        is_own = is_earlier_output(output)
    except OSError as error:
        give_up(unreadable(output, error))
    if is_own:
        return
    if _holds(folders, output):
        give_up(
            say(
                "{file} is among the submissions, and no earlier run has written it; name another "
                "--output",
                file=str(output),
            )
        )
    if not force:
        give_up(
            say(
                "{file} exists, and is no earlier report of this program; name another --output, "
                "or add --force to replace the file",
                file=str(output),
            )
        )


def written_in(folders: Iterable[Path]) -> list[Path]:
    """Return the files in these folders that earlier runs have written."""
    found = [folder / name for folder in folders for name in _written(folder / WRITTEN)]
    return [path for path in found if path.is_file()]


def remember(output: Path | None, folders: Iterable[Path]) -> None:
    """Record that a run has written this file, so that a later run may replace it."""
    if output is not None and output.is_file() and _holds(folders, output):
        names = _written(output)
        if output.name not in names:
            lines = "".join(f"{name}\n" for name in [*names, output.name])
            _list_beside(output).write_text(lines, encoding="utf-8")


def _holds(folders: Iterable[Path], output: Path) -> bool:
    place = output.resolve()
    return any(place.is_relative_to(folder.resolve()) for folder in folders)


def _list_beside(output: Path) -> Path:
    return output.with_name(WRITTEN)


def _written(output: Path) -> list[str]:
    try:
        return _list_beside(output).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError):
        return []
