"""Grade the uploaded files of a class, and make the same reports as ``dh-grader grade``."""

import io
import tempfile
import time
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from http import HTTPStatus
from pathlib import Path, PurePosixPath
from typing import Annotated, Final

from pydantic import Base64Bytes, BaseModel, ConfigDict, Field, ValidationError

from service.api.http.lookup import Catalogue, require_exercise
from service.api.http.problems import ProblemError, invalid, message_of
from service.formats.documents.gradebook import comment
from service.formats.earlier_outputs import is_output
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.plain_text import visible
from service.formats.worksheets import Grade, UnusableWorksheetError, Worksheet, grade_of
from service.local_grading import GradingTerms, graded
from service.submissions.answers import of_file
from service.submissions.assignment import PASS_MARK, Assignment, UnknownPartNameError, of_one
from service.submissions.handed_in import (
    MAX_FILES,
    HandedIn,
    UnusableClassError,
    all_handed_in,
    handed_in_out_of_place,
    leads_out,
)
from service.submissions.strict_json import MAX_BODY_SIZE
from service.translations import ENGLISH, Language, say, told

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
    """A file of a student: as a text, as bytes, or as the texts in a file of an office program."""

    # Bytes if it is not text. Too large a file has none of these.

    model_config = ConfigDict(extra="forbid")

    path: Annotated[str, Field(min_length=1, max_length=_LONGEST_PATH)]
    text: str | None = None
    base64: Base64Bytes | None = None
    members: Annotated[dict[_Member, str], Field(max_length=_MOST_MEMBERS)] | None = None

    @property
    def content(self) -> bytes:
        """Return the bytes of the file."""
        # If the file is too large, zeros that exceed the limit.
        if self.members is not None:
            return _office_file(self.members)
        if self.text is not None:
            return self.text.encode(errors="replace")
        return b"\0" * (MAX_BODY_SIZE + 1) if self.base64 is None else self.base64


def _office_file(members: Mapping[str, str]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, text in members.items():
            archive.writestr(name, text.encode(errors="replace"))
    return packed.getvalue()


class ClassUpload(BaseModel):
    """All files of a class, and the exercise that they answer."""

    # Or the part of an exercise.

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


def _marks(content: bytes) -> int:
    # Return a measure of how many values JSON has, in order to refuse too many before parsing.
    # It is the number of characters outside JSON strings, plus the number of quotation marks.
    content = content.replace(rb"\\", b"").replace(rb"\"", b"")
    quotes = content.count(b'"')
    # With too many quotation marks, do not build the list of pieces between them.
    return quotes if quotes > _MOST_MARKS else quotes + sum(map(len, content.split(b'"')[::2]))


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

    from service.formats import report_format
    from service.formats.shared.report_format import Setting

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
