"""The overview of a class: a folder with an index and a page for each submission.

It also recognises what this program has written, so that nothing else is replaced.
"""

import io
import os
import unicodedata
import zipfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, count, pairwise
from pathlib import Path, PurePath, PurePosixPath
from typing import Final

from dh_grader.formats import FORMAT_NAMES, report_format
from dh_grader.formats.graded import AnsweredExercise, Document, GradedSubmission, Setting
from dh_grader.formats.texts import LONGEST as TEXTS_LONGEST
from dh_grader.formats.texts import (
    SIGNS,
    html_pieces,
    places_in_words,
    points,
    shortened,
    style_sheet,
)
from dh_grader.formats.worksheets import is_worksheet
from dh_grader.grading import Place, Verdict
from dh_grader.regex import regex
from dh_grader.statistics import ClassStatistics, CountedSlip, ScoreBin, Share, columns
from dh_grader.submissions.files import MAX_START, ClassEntry
from dh_grader.submissions.office_files import UNREADABLE_ARCHIVE
from dh_grader.translations import Language, say, say_count

# --- Recognise what this program has written, and the worksheets of platforms, by their contents
#
# Tutors keep reports and worksheets in the folder of the submissions, so these files come back as
# entries of the class. And an output may replace only an earlier output.


# The file that lists what a run has written into a folder.
WRITTEN: Final = ".dh-grader-written"
_PAGE: Final = ".html"
_OVERVIEW: Final = b'content="DH Grader class overview"'
# The endings of the files that platforms call a worksheet or a gradebook.
_WORKSHEETS: Final = frozenset({".csv", ".tsv", ".txt", ".xls"})


def is_output(entry: ClassEntry) -> bool:
    """True if an entry of a class is an output or a worksheet, and no submission."""
    if start := entry.start(""):
        ending = PurePosixPath(entry.name).suffix.lower()
        if is_document(start) or (ending in _WORKSHEETS and is_worksheet(start)):
            return True
        if not start.startswith(b"PK"):
            return False
    names = entry.inside()
    return _is_written(names, entry) or _holds_pages(names, entry)


def _is_written(names: Sequence[str], entry: ClassEntry) -> bool:
    # A run may also have written a file into the folder of a student.
    if WRITTEN not in names:
        return False
    lines = entry.start(WRITTEN).decode(errors="replace").splitlines()
    return {name.partition("/")[0] for name in names} <= {
        WRITTEN,
        *(line.partition("/")[0] for line in lines),
    }


def _holds_pages(names: Sequence[str], entry: ClassEntry) -> bool:
    # A class page, feedback for Moodle, or only pages of students.
    if INDEX in names and _OVERVIEW in entry.start(INDEX)[:_HEAD]:
        return True
    if is_feedback(names):
        return True
    pages = [name for name in names if name.endswith(_PAGE)]
    return bool(pages) and pages == list(names) and is_document(entry.start(pages[0]))


_HEAD: Final = 1_000


def is_feedback(names: Sequence[str]) -> bool:
    """True if these are the names in a zip file of feedback for Moodle."""
    return bool(names) and all(name.endswith(f"/{FEEDBACK}") for name in names)


def is_document(start: bytes) -> bool:
    """True if a document of one of the report formats begins like this."""
    return any(report_format(name).mark.match(start) for name in FORMAT_NAMES)


def is_earlier_output(file: Path) -> bool:
    """True if the file is empty, or a document that this program has written. Raises OSError."""
    with file.open("rb") as opened:
        start = opened.read(MAX_START)
    if not start.strip() or is_document(start):
        return True
    try:
        with zipfile.ZipFile(file) as archive:
            return is_feedback(archive.namelist())
    except UNREADABLE_ARCHIVE:
        return False


# --- The overview of a class: a folder with an index and a page for each submission


__all__ = ["FEEDBACK", "INDEX", "class_folder", "feedback_zip"]


# --- The data of the index, collected from submissions one by one


@dataclass(frozen=True, slots=True)
class ByHand:
    """The reason why a file must be graded by hand; ``file`` is the path to it, or empty."""

    reason: str
    file: str


@dataclass(frozen=True, slots=True)
class SubmissionLine:
    """A submission in the index; ``page`` is the path from the index to its page."""

    name: str
    learner: str
    person: str
    page: str
    points: str
    score: float
    passed: bool
    is_graded: bool
    is_gradable: bool
    problems: tuple[ByHand, ...]


@dataclass(slots=True)
class Overview:
    """A class: its exercises by id, a line for each submission, and the statistics.

    In the statistics, the number of a submission is its index in ``lines``.
    """

    exercises: dict[str, AnsweredExercise]
    lines: list[SubmissionLine] = field(default_factory=list)
    statistics: ClassStatistics = field(default_factory=ClassStatistics)
    pass_mark: float = 0.0
    graders: set[str] = field(default_factory=set)
    # The folder of the index, from which the paths to files lead; None if it is unknown.
    folder: Path | None = None
    # The entries of the class that are no submissions.
    left_out: tuple[str, ...] = ()
    _learners: Counter[str] = field(default_factory=Counter)

    def add(self, submission: GradedSubmission, page: str) -> None:
        """Count a submission and add its line; its reports are not stored."""
        number = len(self.lines)
        self.pass_mark = submission.pass_mark
        self._learners[submission.learner] += 1
        self.lines.append(
            SubmissionLine(
                name=submission.name,
                learner=submission.learner,
                person=submission.person,
                page=page,
                points=points(submission.points, submission.max_points),
                score=submission.score,
                passed=submission.passed,
                is_graded=submission.is_complete,
                is_gradable=submission.is_gradable,
                problems=_problems(submission, self.folder),
            )
        )
        if submission.is_complete:
            self.statistics.scores.add(submission.score, passed=submission.passed)
        for file in submission.files:
            self.exercises.setdefault(file.exercise.id, file.exercise)
            if file.report is not None:
                self.graders.add(file.report.grader)
                self.statistics.add(number, file.report)

    def listed(self, numbers: Iterable[int]) -> list[SubmissionLine]:
        """Return the index's lines for the submissions with these numbers."""
        return [self.lines[number] for number in numbers]

    def shown(self, line: SubmissionLine) -> str:
        """Return the learner's name, or the submission's if the learner has several submissions.

        If the name in the gradebook is a number, the name of the person is before it.
        """
        if self._learners[line.learner] > 1:
            return line.name
        is_known = not line.person or line.person == line.learner
        return line.learner if is_known else f"{line.person} ({line.learner})"

    @property
    def ungraded(self) -> list[SubmissionLine]:
        """Return the submissions with a problem, and those in which nothing was readable."""
        return [line for line in self.lines if line.problems or not line.is_gradable]


def _problems(submission: GradedSubmission, folder: Path | None) -> tuple[ByHand, ...]:
    has_several = len(submission.files) > 1
    found = (
        ByHand(
            f"{file.exercise.title}: {file.problem}" if has_several else file.problem,
            _path(file.file, folder),
        )
        for file in submission.files
        if file.problem
    )
    return tuple(dict.fromkeys(found))


def _path(file: str, folder: Path | None) -> str:
    # A file in a zip file has no path.
    if folder is None or not file or not Path(file).is_file():
        return ""
    try:
        return Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # on another drive of Windows
        return Path(file).absolute().as_uri()


# --- The index of a class, for tutors: scores, success, identical mistakes, and all submissions


INDEX: Final = "index.html"
STYLE: Final = style_sheet(Path(__file__).with_name("templates") / "index.css")
# The shares at which a cell gets the next colour. The cell also shows the number.
_BANDS: Final = (0.0, 0.25, 0.5, 0.75, 0.9)


def index(overview: Overview, language: Language) -> Iterator[bytes]:
    """Yield the index in a language, piece by piece."""
    return html_pieces(
        "formats/templates/index.html",
        language=language,
        style=STYLE,
        title=_title(overview),
        overview=overview,
        sources=dict.fromkeys(each.source for each in overview.exercises.values()),
        titles=_part_titles(overview),
        bands=list(pairwise(f"{edge * 100:.0f}" for edge in (*_BANDS, 1.0))),
        band_of=_band_of,
        bars_of=_bars_of,
        columns_of=columns,
        grouped="{:,}".format,
        place_of=_place_of,
        untold=_untold,
        wrong_cells=_wrong_cells,
        sentence_of=_sentence_of,
        signs=SIGNS,
        span_of=_span_of,
        verdicts=Verdict,
    )


def _title(overview: Overview) -> str:
    if len(overview.exercises) == 1:
        return next(iter(overview.exercises.values())).title
    count = len(overview.exercises)
    return say_count("1 exercise", "{number} exercises", count=count, number=f"{count:,}")


def _part_titles(overview: Overview) -> Mapping[tuple[str, str], str]:
    has_several = len(overview.exercises) > 1
    return {
        (each.id, part.id): f"{each.title}: {part.title}" if has_several else part.title
        for each in overview.exercises.values()
        for part in each.parts
    }


def _untold(count: int) -> str:
    return say_count(
        "1 report without misconceptions, because of the feedback level. To see them, grade again "
        "with --feedback full.",
        "{number} reports without misconceptions, because of the feedback level. To see them, "
        "grade again with --feedback full.",
        count=count,
        number=f"{count:,}",
    )


def _wrong_cells(count: int) -> str:
    return say_count("1 wrong cell", "{number} wrong cells", count=count, number=f"{count:,}")


def _place_of(row: str, cell: str) -> str:
    return places_in_words([Place(row, cell)])


def _sentence_of(slip: CountedSlip) -> str:
    return shortened(slip.sentence, TEXTS_LONGEST)


def _band_of(share: Share) -> str:
    if share.value is None:
        return "share-none"
    return f"share{sum(share.value >= low for low in _BANDS) - 1}"


def _span_of(each: ScoreBin) -> str:
    low, high = f"{each.low * 100:.0f}", f"{each.high * 100:.0f}"
    if each.high == 1:
        return say("{low} to {high} %", low=low, high=high)
    return say("{low} to under {high} %", low=low, high=high)


def _bars_of(each: ScoreBin, highest: int) -> Iterator[tuple[str, str, str]]:
    tall, below = (100 * n / highest for n in (each.count, each.count - each.passed))
    for side, top, height in (("below", 100 - below, below), ("over", 100 - tall, tall - below)):
        if each.count and f"{height:.2f}" != "0.00":
            yield side, f"{top:.2f}", f"{height:.2f}"


# --- Safe file names made from the names of submissions, which are untrusted


# Characters. A file name has 255 bytes on most systems, and a letter up to four bytes.
LONGEST: Final = 50
_SIGNS: Final = "-_"
_RESERVED: Final = frozenset(
    {"con", "prn", "aux", "nul"} | {f"{port}{i}" for port in ("com", "lpt") for i in range(10)}
)


def distinct_file_names(ending: str) -> Callable[[str], str]:
    """Return a function that makes distinct, safe file names for one folder."""
    # The names are distinct even on systems that ignore case or the form of accented letters.
    used: set[str] = set()

    def distinct(name: str) -> str:
        stem = file_stem(name)
        numbered = (f"{stem}-{i}" for i in count(2))
        free = next(each for each in chain([stem], numbered) if _compared(each) not in used)
        used.add(_compared(free))
        return f"{free}{ending}"

    return distinct


def file_stem(name: str) -> str:
    """Return a name as a safe file name without an ending."""
    composed = unicodedata.normalize("NFC", name)
    kept = "".join(c if c.isalnum() or c in _SIGNS else " " for c in composed)
    stem = "-".join(kept.split())[:LONGEST].strip(_SIGNS)
    if not stem:
        return "submission"
    return f"{stem}-" if stem.lower() in _RESERVED else stem


def _compared(stem: str) -> str:
    return unicodedata.normalize("NFKC", stem).casefold()


# --- The folder of a class: a page for each submission, then the index


# The subfolder of the pages.
PAGES: Final = "reports"
# The name of the page of each student in the zip file for Moodle.
FEEDBACK: Final = "feedback.html"

# The student and the number in the names that Moodle gives.
_MOODLE: Final = regex(r"(?P<name>.+?)_(?P<number>\d+)(?:_assignsubmission_.*)?")

Pages = Callable[[Iterable[GradedSubmission], Setting], Iterator[bytes]]
Folder = Callable[[Iterable[GradedSubmission], Setting], Iterator[Document]]


def class_folder(page: Pages) -> Folder:
    """Return a function that yields the files of a class's folder.

    ``page`` writes the page of one submission.
    """

    def documents(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[Document]:
        overview = Overview(
            {each.id: each for each in setting.exercises},
            folder=setting.folder,
            left_out=setting.left_out,
        )
        file_name = distinct_file_names(".html")
        for submission in submissions:
            path = f"{PAGES}/{file_name(submission.learner)}"
            overview.add(submission, path)
            yield Document(path, page([submission], setting))
        yield Document(INDEX, index(overview, setting.language))

    return documents


def feedback_zip(
    submissions: Iterable[GradedSubmission], setting: Setting, page: Pages
) -> Iterator[bytes]:
    """Yield a zip file with the page of each submission, as Moodle takes feedback files.

    Moodle (``mod/assign/feedback/file/importziplib.php``) divides the name of a folder at ``_``;
    the second piece is the number of the student.
    """
    file_name = distinct_file_names("")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for submission in submissions:
            folder = file_name(submission.learner)
            found = _MOODLE.fullmatch(PurePath(submission.name).name)
            if found and submission.learner.endswith(f" {found['number']}"):
                name = found["name"].replace("_", " ")
                folder = f"{name}_{found['number']}_assignsubmission_file_"
            archive.writestr(f"{folder}/{FEEDBACK}", b"".join(page([submission], setting)))
    yield packed.getvalue()
