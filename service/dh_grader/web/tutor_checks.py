"""What the editor and the page of a class compute: checks, previews, files, imports, reports.

The routes and pages are in ``tutor.py``. Nothing here is specific to HTTP but the errors.
"""

import hashlib
import io
import os
import subprocess
import sys
import tempfile
import threading
import time
import weakref
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from http import HTTPStatus
from itertools import chain, count
from pathlib import Path, PurePosixPath
from threading import Lock
from typing import IO, Annotated, Final, Literal

from pydantic import Base64Bytes, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from dh_grader.api.http import Catalogue, ProblemError, invalid, message_of, require_exercise
from dh_grader.catalogue import (
    ID_ADVICE,
    CatalogueError,
    Exercise,
    Fault,
    exercise_files,
    is_exercise_id,
    read_exercise,
    read_regular,
)
from dh_grader.catalogue.files import line_of, value_lines
from dh_grader.expressions import AngleUnit
from dh_grader.formats.class_page import is_output
from dh_grader.formats.documents import comment
from dh_grader.formats.graded import GradedSubmission, GradingTerms, graded
from dh_grader.formats.texts import number, visible
from dh_grader.formats.worksheets import Grade, UnusableWorksheetError, Worksheet, grade_of
from dh_grader.importing import (
    ImportedRobot,
    ImportOptions,
    RefusedRobotError,
    imported_table,
    imported_urdf,
)
from dh_grader.kinematics import Convention
from dh_grader.submissions import PASS_MARK, Assignment, UnknownPartNameError, of_one
from dh_grader.submissions.answers import of_file
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.submissions.files import (
    MAX_FILES,
    MAX_TOML_DOTS,
    HandedIn,
    UnusableClassError,
    all_handed_in,
    handed_in_out_of_place,
    leads_out,
)
from dh_grader.translations import ENGLISH, Language, Translation, reason_of, say, told
from dh_grader.typeset import statement_html

# --- Check the text of an exercise file in the editor, and preview the exercise


# The largest exercise that comes with the program has 8 kB.
MAX_CHARACTERS: Final = 64 * 1024


class CheckRequest(BaseModel):
    """The text of an exercise file to check."""

    model_config = ConfigDict(extra="forbid")

    id: Annotated[str, Field(max_length=100)]
    text: Annotated[str, Field(max_length=MAX_CHARACTERS)]


@dataclass(frozen=True, slots=True)
class FileFinding:
    """A problem in an exercise file: ``level`` is unusable, failed or warning."""

    level: str
    field: str
    text: str
    line: int | None


@dataclass(frozen=True, slots=True)
class ExercisePreview:
    """A short preview of what students will see."""

    title: str
    source: str
    statement_html: str
    parts: tuple[str, ...]
    figure: str | None


@dataclass(frozen=True, slots=True)
class CheckAnswer:
    """The findings on an exercise file, and a preview if the file can be used."""

    findings: tuple[FileFinding, ...]
    summary: str
    preview: ExercisePreview | None = None


_ANSWER: Final = TypeAdapter(CheckAnswer)


def checked(body: CheckRequest, language: Language = ENGLISH) -> bytes:
    """Return the findings on an exercise file as JSON."""
    return _ANSWER.dump_json(check(body.id, body.text, language))


def check(exercise_id: str, text: str, language: Language = ENGLISH) -> CheckAnswer:
    """Return the findings of ``exercises check`` on an exercise file with this text."""
    # Imported here, because it loads an algebra system.
    from dh_grader.authoring import examine, summary

    translation = language.translation

    try:
        exercise = exercise_of(exercise_id, text)
    except CatalogueError as error:
        faults = (
            FileFinding("unusable", each.field, told(each.reason, translation), each.line)
            for each in error.faults
        )
        return CheckAnswer(tuple(faults), told(say("The file cannot be used."), translation))
    lines = value_lines(text.replace("\r\n", "\n"))
    findings = tuple(
        FileFinding(
            remark.level.value,
            remark.field,
            told(remark.text, translation),
            line_of(remark.field, lines),
        )
        for remark in examine(exercise)
    )
    return CheckAnswer(
        findings,
        told(summary(exercise), translation),
        _preview(exercise, translation),
    )


def exercise_of(exercise_id: str, text: str) -> Exercise:
    """Return the exercise that a file with this id and text defines. Raises CatalogueError."""
    file = Path(f"{exercise_id}.toml")
    if not is_exercise_id(exercise_id):
        raise CatalogueError(
            [Fault(file, "", say("the id is the name of the file: {advice}", advice=ID_ADVICE))]
        )
    if text.count(".") > MAX_TOML_DOTS:
        raise CatalogueError(
            [Fault(file, "", say("has more than {most:,} dots", most=MAX_TOML_DOTS))]
        )
    return read_exercise(file, text)


def _preview(exercise: Exercise, translation: Translation | None) -> ExercisePreview:
    from dh_grader.figures import exercise_figure

    points = (say("{points} points", points=number(part.points)) for part in exercise.parts)
    parts = tuple(
        f"{part.title}, {told(worth, translation)}"
        for part, worth in zip(exercise.parts, points, strict=True)
    )
    return ExercisePreview(
        exercise.title,
        exercise.source,
        statement_html(exercise.statement, exercise.symbols),
        parts,
        exercise_figure(exercise) if exercise.reference is not None else None,
    )


# --- Check exercise files for the editor, in a process that is killed if it takes too long


# Ten times what `exercises check` takes for the largest exercise of the catalogue.
SECONDS: Final = 20.0
# An idle process ends, because it holds about 120 MB.
IDLE_SECONDS: Final = 300.0
# Seconds until a new process is ready, even on a very busy machine.
_START: Final = 60.0
# The first byte of a message.
READY: Final = b"r"
DONE: Final = b"d"
_MODULE: Final = "dh_grader.web.check_process"


class Checking:
    """Checks exercise files one by one in a process that starts with the first check."""

    def __init__(self, seconds: float = SECONDS) -> None:
        self._seconds = seconds
        self._process: subprocess.Popen[bytes] | None = None
        self._is_ready = False
        self._closed = False

    def checked(self, body: CheckRequest, language: Language = ENGLISH) -> bytes:
        """Return the findings on an exercise file as JSON.

        Only one thread may call this method at a time. Raises ProblemError if the checks take too
        long, or if the service ends.
        """
        if self._process is None or self._process.poll() is not None:
            self._start()
        process = self._process
        assert process is not None
        try:
            content = self._asked(process, f"{language.code}\n{body.model_dump_json()}".encode())
        except BaseException as error:
            _end(process)
            if self._closed:
                raise _ending() from error
            if isinstance(error, _TooLongError):
                raise _too_long(self._seconds) from error
            if isinstance(error, OSError) and process.returncode == 0:
                # The idle process has ended just now.
                return self.checked(body, language)
            raise
        if not content:
            raise RuntimeError("the checks failed; the log has their traceback")
        return content

    def close(self) -> None:
        """Kill the process, even during a check."""
        self._closed = True
        if self._process is not None:
            # The thread that waits for its answer finds the pipe closed.
            self._process.kill()

    def _start(self) -> None:
        if self._closed:
            raise _ending()
        # In a new session, Ctrl+C in the terminal reaches only the service, which kills this one.
        self._process = subprocess.Popen(
            [sys.executable, "-m", _MODULE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=os.name == "posix",
        )
        self._is_ready = False
        weakref.finalize(self, _end, self._process)

    def _asked(self, process: "subprocess.Popen[bytes]", body: bytes) -> bytes:
        # The service may have ended just before this process was started.
        if self._closed:
            raise ConnectionResetError
        if not self._is_ready:
            _answer(process, READY, _START)
            self._is_ready = True
        assert process.stdin is not None
        send(process.stdin, DONE, body)
        return _answer(process, DONE, self._seconds)


class _TooLongError(Exception):
    """The process has not replied in time."""


def _answer(process: "subprocess.Popen[bytes]", expected: bytes, seconds: float) -> bytes:
    late = threading.Event()

    def give_up() -> None:
        late.set()
        process.kill()

    timer = threading.Timer(seconds, give_up)
    timer.daemon = True
    timer.start()
    try:
        assert process.stdout is not None
        kind, content = received(process.stdout)
    except EOFError as error:
        if late.is_set():
            raise _TooLongError from error
        raise ConnectionResetError("the process of the checks has ended") from error
    finally:
        timer.cancel()
    return content if kind == expected else b""


def send(pipe: IO[bytes], kind: bytes, content: bytes = b"") -> None:
    """Write a message: a byte for its kind, its length, its content."""
    pipe.write(kind + len(content).to_bytes(4) + content)
    pipe.flush()


def received(pipe: IO[bytes]) -> tuple[bytes, bytes]:
    """Return the kind and the content of the next message. Raises EOFError."""
    head = pipe.read(5)
    content = pipe.read(int.from_bytes(head[1:])) if len(head) == 5 else b""
    if len(head) < 5 or len(content) < int.from_bytes(head[1:]):
        raise EOFError
    return head[:1], content


def _end(process: "subprocess.Popen[bytes]") -> None:
    process.kill()
    process.wait()
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            try:
                pipe.close()
            except OSError:
                # A part of the last message was not written.
                continue


def _too_long(seconds: float) -> ProblemError:
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        say(
            "The checks of this exercise take more than {seconds} seconds, so they were stopped. "
            "Check fewer parts at once, or use dh-grader exercises check FILE, which has no limit.",
            seconds=f"{seconds:g}",
        ),
        "checks-too-long",
        say("The checks take too long"),
    )


def _ending() -> ProblemError:
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE,
        say("The service is shutting down. Send this request again in a minute."),
        headers={"Retry-After": "60"},
    )


# --- The exercise files that the editor opens, and the folder in which it saves them


# A character of the text has four bytes at most.
_LARGEST: Final = 4 * MAX_CHARACTERS
# The most characters of an id before "-copy" and a number.
_LONGEST_START: Final = 50


class SaveRequest(CheckRequest):
    """The text of an exercise file to save.

    ``before`` is the hash of the file that it replaces, or "".
    """

    before: Annotated[str, Field(max_length=64)] = ""


@dataclass(frozen=True, slots=True)
class OpenedFile:
    """The text of an exercise file; ``mark`` is its hash, or "" outside the editor's folder."""

    text: str
    mark: str


class ExerciseFolder:
    """The files in the catalogue's folders and in the editor's own folder."""

    def __init__(self, folders: Sequence[Path], written: Path | None) -> None:
        self._folders = folders
        self._written = written
        self._writing = Lock()

    @property
    def can_write(self) -> bool:
        """True if the editor may save files."""
        return self._written is not None

    def opened(self, exercise_id: str) -> OpenedFile | None:
        """Return the file of an exercise, first of the editor's own folder, or None."""
        if not is_exercise_id(exercise_id):
            return None
        own = self._own(exercise_id)
        if own is not None:
            return OpenedFile(own.decode(errors="replace"), _mark(own))
        found = self._files().get(exercise_id)
        if found is None:
            return None
        return OpenedFile(read_regular(found, _LARGEST).decode(errors="replace"), "")

    def free_id(self, exercise_id: str) -> str:
        """Return an unused id for a copy of an exercise."""
        copies = (f"{exercise_id[:_LONGEST_START]}-copy{i}" for i in chain([""], count(2)))
        taken = self._files()
        return next(each for each in copies if each not in taken and self._own(each) is None)

    def save(self, body: SaveRequest) -> str:
        """Save a file, and return the hash of its content. Raises ProblemError."""
        # At any time, the file has either the whole old content or the whole new content.
        if self._written is None:
            raise _not_saved(
                say("This service cannot save files: DH_GRADER_EDITOR_DIR is not set.")
            )
        if not is_exercise_id(body.id):
            raise _not_saved(
                say("This cannot be the id of an exercise: {advice}.", advice=ID_ADVICE)
            )
        try:
            exercise_of(body.id, body.text)
        except CatalogueError as error:
            raise _not_saved(say("The file cannot be used. Fix it before you save it.")) from error
        content = body.text.encode()
        with self._writing:
            try:
                self._write(self._written / f"{body.id}.toml", content, body)
            except OSError as error:
                raise _not_saved(
                    say("The file cannot be saved: {reason}.", reason=reason_of(error))
                ) from error
        return _mark(content)

    def _write(self, file: Path, content: bytes, body: SaveRequest) -> None:
        handle, name = tempfile.mkstemp(prefix=f".{body.id}-", dir=file.parent)
        written = Path(name)
        try:
            with os.fdopen(handle, "wb") as output:
                output.write(content)
                output.flush()
                os.fsync(output.fileno())
            written.chmod(0o644)
            own = self._own(body.id)
            if (_mark(own) if own is not None else "") != body.before:
                raise _changed(body.id)
            if own is None:
                if body.id in self._files():
                    raise _not_saved(say("The id {id} is taken. Choose another one.", id=body.id))
                # Unlike a move, this fails if the file was created meanwhile.
                os.link(written, file)
            else:
                written.replace(file)
        except FileExistsError as error:
            raise _changed(body.id) from error
        finally:
            written.unlink(missing_ok=True)

    def _files(self) -> dict[str, Path]:
        """Return the files in the catalogue's folders, by exercise id."""
        try:
            return {file.stem: file for file in exercise_files(*self._folders)}
        except CatalogueError:
            return {}

    def _own(self, exercise_id: str) -> bytes | None:
        if self._written is None:
            return None
        try:
            return read_regular(self._written / f"{exercise_id}.toml", _LARGEST)
        except FileNotFoundError:
            return None


def _mark(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _not_saved(detail: str) -> ProblemError:
    return ProblemError(HTTPStatus.CONFLICT, detail, "not-saved", say("The file is not saved"))


def _changed(exercise_id: str) -> ProblemError:
    return _not_saved(
        say(
            "{exercise}.toml has changed since you opened it, so it was not overwritten. Download "
            "your text, open the file again, and merge the two.",
            exercise=exercise_id,
        )
    )


# --- Make the text of an exercise file from a URDF file or a pasted DH table, for the editor


_Name = Annotated[str, Field(max_length=200)]
_ROBOT: Final = TypeAdapter(ImportedRobot)


class ImportRequest(BaseModel):
    """A robot as text (URDF or a DH table), and the author's choices."""

    model_config = ConfigDict(extra="forbid")

    kind: Literal["urdf", "table"]
    text: Annotated[str, Field(max_length=MAX_BODY_SIZE)]
    id: _Name
    title: _Name = ""
    base: _Name = ""
    tip: _Name = ""
    letters: bool = False
    convention: Convention | None = None
    order: _Name = ""
    unit: _Name = ""
    angles: Literal["", AngleUnit] = ""


def imported(body: ImportRequest, language: Language = ENGLISH) -> bytes:
    """Return the exercise file for a robot, or questions about it, as JSON. Raises ProblemError."""
    if not is_exercise_id(body.id):
        raise _unusable_robot(
            say("This cannot be the id of an exercise: {advice}.", advice=ID_ADVICE)
        )
    options = ImportOptions(
        title=body.title or body.id,
        source="Imported from a URDF file" if body.kind == "urdf" else "Imported from a DH table",
        convention=body.convention,
        base=body.base,
        tip=body.tip,
        letters=body.letters,
        order=body.order,
        unit=body.unit,
        angles=body.angles,
    )
    try:
        if body.kind == "urdf":
            found = imported_urdf(body.text.encode(), options)
        else:
            found = imported_table(body.text, options)
    except RefusedRobotError as error:
        reason = told(message_of(error), language.translation).rstrip(".。")
        raise _unusable_robot(
            say("{reason}.", reason=f"{reason[:1].upper()}{reason[1:]}")
        ) from error
    remarks = [told(each, language.translation) for each in found.remarks]
    questions = [
        replace(each, text=told(each.text, language.translation)) for each in found.questions
    ]
    return _ROBOT.dump_json(replace(found, remarks=remarks, questions=questions))


def _unusable_robot(detail: str) -> ProblemError:
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        detail,
        "unusable-robot",
        say("The robot cannot become an exercise"),
    )


# --- Grade the uploaded files of a class, and make the same reports as ``dh-grader grade``


# Bytes after unpacking. A body has at most 256 KiB, but similar submissions compress well.
MAX_UPLOAD: Final = 8 * 1024 * 1024
MAX_SUBMISSIONS: Final = 500
# The names in the archive: the gradebook, the filled worksheet, and what is told about it.
GRADES: Final = "grades.csv"
WORKSHEET: Final = "worksheet-graded.csv"
TOLD: Final = "worksheet.txt"
# Bytes and cells of a worksheet. A gradebook of 500 students has some 50,000 cells.
MAX_SHEET: Final = 1024 * 1024
MAX_SHEET_CELLS: Final = 100_000
# Seconds. An ordinary class takes one or two; only files made to be costly take longer.
MOST_SECONDS: Final = 60.0
_LONGEST_PATH: Final = 1_000
# The most characters of JSON outside texts, including the quotation marks around texts. Each may
# take a hundred bytes of memory when it is parsed. The page sends 15 for each file.
_MOST_MARKS: Final = 50 * MAX_FILES
# The most files in a file of an office program. The page sends four marks for each.
_MOST_MEMBERS: Final = 100
_Member = Annotated[str, Field(min_length=1, max_length=200)]
# In bytes of UTF-8; no common file system allows more.
_LONGEST_NAME: Final = 255


class UploadedFile(BaseModel):
    """A file of a student: as a text, as bytes, or as the texts in a file of an office program.

    A file that is too large has none of these.
    """

    model_config = ConfigDict(extra="forbid")

    path: Annotated[str, Field(min_length=1, max_length=_LONGEST_PATH)]
    text: str | None = None
    base64: Base64Bytes | None = None
    members: Annotated[dict[_Member, str], Field(max_length=_MOST_MEMBERS)] | None = None

    @property
    def content(self) -> bytes:
        """Return the bytes of the file; of too large a file, zeros that exceed the limit."""
        if self.members is not None:
            return _office_file(self.members)
        if self.text is not None:
            return self.text.encode(errors="replace")
        return b"\0" * (MAX_BODY_SIZE + 1) if self.base64 is None else self.base64


class ClassUpload(BaseModel):
    """All files of a class, and the exercise, or the part of one, that they answer."""

    model_config = ConfigDict(extra="forbid")

    exercise: str
    part: str | None = None
    # The worksheet or gradebook of a platform, and its column for the grades.
    worksheet: UploadedFile | None = None
    column: Annotated[str, Field(max_length=_LONGEST_PATH)] | None = None
    files: Annotated[list[UploadedFile], Field(min_length=1, max_length=MAX_FILES)]


def unpacked(body: bytes) -> ClassUpload:
    """Return the upload in a request body: JSON compressed by gzip. Raises ProblemError."""
    unpacker = zlib.decompressobj(16 + zlib.MAX_WBITS)
    try:
        content = unpacker.decompress(body, MAX_UPLOAD)
    except zlib.error as error:
        raise _unusable(say("The body is not packed by gzip.")) from error
    if unpacker.unconsumed_tail or not unpacker.eof:
        raise _unusable(
            say(
                "The files are more than {most} MiB. Choose fewer, or use dh-grader grade FOLDER "
                "--format html.",
                most=MAX_UPLOAD // 1024 // 1024,
            )
        )
    if _marks(content) > _MOST_MARKS:
        raise _unusable(
            say("The body holds more than the files of a class, their paths and contents.")
        )
    try:
        return ClassUpload.model_validate_json(content)
    except ValidationError as error:
        details = error.errors(include_url=False, include_input=False)
        raise invalid(details, list(ClassUpload.model_fields)) from error


def class_archive(upload: ClassUpload, catalogue: Catalogue, language: Language = ENGLISH) -> bytes:
    """Grade a class, and return the reports and the gradebook as a ZIP file.

    Raises ProblemError.
    """
    # While the files are graded, they are in a temporary folder, so that they are found and read as
    # on the command line.
    exercise = require_exercise(catalogue, upload.exercise)
    try:
        assignment = of_one(exercise, upload.part)
    except UnknownPartNameError as error:
        raise _unusable(message_of(error)) from error
    sheet = _worksheet(upload)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        misplaced = _write(upload, folder)
        found, left_out = _found(folder, assignment, misplaced)
        if not found:
            raise _unusable(say("There is no submission among these files."))
        if len(found) > MAX_SUBMISSIONS:
            raise _unusable(
                say(
                    "There are more than {most} submissions. Choose fewer, or use dh-grader grade "
                    "FOLDER --format html.",
                    most=MAX_SUBMISSIONS,
                )
            )
        if sheet is not None:
            found = [
                replace(each, person=sheet.person(each.name, each.learner) or each.person)
                for each in found
            ]
        return _archive(_Class(found, left_out, assignment, folder, sheet), language)


def _office_file(members: Mapping[str, str]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, text in members.items():
            archive.writestr(name, text.encode(errors="replace"))
    return packed.getvalue()


def _marks(content: bytes) -> int:
    # Return a measure of how many values JSON has, in order to refuse too many before parsing.
    # It is the number of characters outside JSON strings, plus the number of quotation marks.
    content = content.replace(rb"\\", b"").replace(rb"\"", b"")
    quotes = content.count(b'"')
    # With too many quotation marks, do not build the list of pieces between them.
    return quotes if quotes > _MOST_MARKS else quotes + sum(map(len, content.split(b'"')[::2]))


@dataclass(frozen=True, slots=True)
class _Class:
    found: list[HandedIn]
    # The entries that are no submissions.
    left_out: list[str]
    assignment: Assignment
    folder: Path
    sheet: Worksheet | None


def _worksheet(upload: ClassUpload) -> Worksheet | None:
    if upload.worksheet is None:
        return None
    name, content = PurePosixPath(upload.worksheet.path).name, upload.worksheet.content
    if len(content) > MAX_SHEET or sum(map(content.count, b",;\t\n")) > MAX_SHEET_CELLS:
        raise _unusable(say("{name} is too large for this page.", name=name))
    try:
        return Worksheet(content, upload.column or None)
    except UnusableWorksheetError as error:
        raise _unusable(of_file(name, error.args[0])) from error


def _found(
    folder: Path, assignment: Assignment, misplaced: Sequence[str]
) -> tuple[list[HandedIn], list[str]]:
    outputs: list[str] = []
    parts = assignment.part_names
    above = f"{folder}/"
    try:
        found = list(all_handed_in([folder], parts=parts, is_output=is_output, outputs=outputs))
    except UnusableClassError as error:
        raise _unusable(message_of(error).replace(above, "")) from error
    for path in misplaced:
        other = handed_in_out_of_place(path, parts)
        same = [i for i, each in enumerate(found) if each.learner == other.learner]
        if len(same) == 1:
            own = found[same[0]]
            found[same[0]] = replace(own, entries=(*own.entries, *other.entries))
        else:
            found.append(other)
    return found, [path.removeprefix(above) for path in outputs]


def _write(upload: ClassUpload, folder: Path) -> list[str]:
    # Return the paths that lead out of the class, of which nothing is written.
    misplaced = []
    for file in upload.files:
        if leads_out(file.path):
            misplaced.append(file.path)
            continue
        path = PurePosixPath(file.path)
        is_usable = all(
            step not in ("", ".", "..") and "\0" not in step
            and len(step.encode(errors="replace")) <= _LONGEST_NAME
            for step in file.path.split("/")
        )  # fmt: skip
        try:
            if not is_usable:
                raise OSError
            target = folder / path
            target.parent.mkdir(parents=True, exist_ok=True)
            with target.open("xb") as output:
                output.write(file.content)
        except (OSError, ValueError) as error:
            shown = file.path[:60].encode("ascii", "backslashreplace").decode()
            raise _unusable(
                say("A file has a name that cannot be used here: {file}", file=shown)
            ) from error
    return misplaced


def _archive(own: _Class, language: Language) -> bytes:
    # Imported here, because grading over HTTP does not need them.
    from rich.console import Console

    from dh_grader.formats import report_format
    from dh_grader.formats.graded import Setting

    chosen = report_format("html")
    assert chosen.folder is not None
    terms = GradingTerms(
        own.assignment,
        PASS_MARK,
        for_students=chosen.for_students,
        echo=chosen.shows_entries,
        language=language,
    )
    console = Console(file=io.StringIO())
    setting = Setting(
        terms.answered,
        console,
        datetime.now(UTC),
        language=language,
        left_out=tuple(own.left_out),
    )
    packed = io.BytesIO()
    gradebook = report_format("gradebook")
    lines: list[bytes] = []
    grades: list[Grade] = []

    def noted(submissions: Iterator[GradedSubmission]) -> Iterator[GradedSubmission]:
        for submission in submissions:
            heading, line = gradebook.pieces([submission], setting)
            lines.extend([line] if lines else [heading, line])
            if own.sheet:
                grades.append(grade_of(submission, comment(submission, language)))
            yield submission

    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for document in chosen.folder(noted(_all_graded(own.found, terms, own.folder)), setting):
            archive.writestr(document.path, b"".join(document.pieces))
        archive.writestr(GRADES, b"".join(lines))
        if own.sheet:
            _add_worksheet(archive, own.sheet, grades, language)
    return packed.getvalue()


def _add_worksheet(
    archive: zipfile.ZipFile, sheet: Worksheet, grades: Sequence[Grade], language: Language
) -> None:
    filled = sheet.filled(grades)
    counts = say(
        "Grades filled in: {count}. Already the same: {same}. Left for grading by hand: {left}.",
        count=filled.grades,
        same=filled.same,
        left=filled.by_hand,
    )
    sentences = [told(each, language.translation) for each in (counts, *filled.problems)]
    archive.writestr(TOLD, "\n".join(map(visible, sentences)))
    if filled.content != sheet.content:
        archive.writestr(WORKSHEET, filled.content)


def _all_graded(
    found: list[HandedIn], terms: GradingTerms, folder: Path
) -> Iterator[GradedSubmission]:
    above = f"{folder}/"
    end = time.monotonic() + MOST_SECONDS
    for handed in found:
        if time.monotonic() >= end:
            raise _unusable(
                say(
                    "Grading these files takes more than {seconds} seconds. Choose fewer, or use "
                    "dh-grader grade FOLDER --format html.",
                    seconds=f"{MOST_SECONDS:g}",
                )
            )
        submission = graded(handed, terms)
        files = tuple(
            replace(
                file,
                file=file.file.removeprefix(above),
                problem=file.problem.replace(above, ""),
            )
            for file in submission.files
        )
        yield replace(submission, name=submission.name.removeprefix(above), files=files)


def _unusable(detail: str) -> ProblemError:
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY, detail, "unusable-files", say("The files cannot be used")
    )
