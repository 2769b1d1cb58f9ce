"""Assignments: exercises for one hand-in, their points, and the names of answer files.

The other files of this package read what is handed in; grading it is not their matter.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Annotated, Any, Final

from pydantic import AfterValidator, BaseModel, BeforeValidator, Field, model_validator

from dh_grader.catalogue import Exercise, FeedbackLevel, load_exercise
from dh_grader.catalogue.files import load_toml
from dh_grader.catalogue.robot import FieldError
from dh_grader.catalogue.schema_fields import Identifier, NotBool, StrictModel, Text
from dh_grader.regex import regex
from dh_grader.submissions.bodies import UnknownExerciseError, nearest
from dh_grader.translations import paragraph, say
from dh_grader.variants import hidden_variant

# --- The outline of an exercise on a server: the data needed to submit answers to it


@dataclass(frozen=True, slots=True)
class PartOutline:
    """A part of an exercise on a server."""

    id: str
    title: str
    points: float


@dataclass(frozen=True, slots=True)
class ExerciseOutline:
    """An exercise on a server. ``feedback`` is the highest level that the server gives."""

    id: str
    version: str
    title: str
    source: str
    feedback: FeedbackLevel
    parts: tuple[PartOutline, ...]


# An assigned exercise; this program can grade only an Exercise, not an ExerciseOutline.
SetExercise = Exercise | ExerciseOutline


# --- Assignments: exercises for one hand-in, their points, and the names of answer files


PASS_MARK: Final = 0.8
MAX_EXERCISES: Final = 100


def _as_list(value: object) -> object:
    return [value] if isinstance(value, str) else value


def _names_a_file(value: str) -> str:
    if not PurePosixPath(value).name:
        raise ValueError(
            say('{value!r} names no file; write a name such as "table.csv" or "*.tex"', value=value)
        )
    return value


_Pattern = Annotated[Text, AfterValidator(_names_a_file)]
Patterns = Annotated[list[_Pattern], BeforeValidator(_as_list), Field(min_length=1, max_length=100)]


class AssignedExerciseSpec(StrictModel):
    """One exercise of an assignment, given by its id in the catalogue or by its file."""

    id: Identifier | None = None
    """The id of an exercise of the catalogue."""
    path: Text | None = None
    """The path of your own exercise file, relative to this file, instead of ``id``."""
    points: Annotated[float, Field(gt=0, le=10_000, strict=True), NotBool] | None = None
    """The points of the exercise. Default: the sum of its parts."""
    parts: Annotated[list[Identifier], Field(min_length=1)] | None = None
    """The parts to answer. Default: all."""
    files: Patterns | None = None
    """The names of answer files, as one text or a list; ``*`` matches any characters. Default:
    ``ID.json``, ``ID/PART.csv`` and similar names."""
    part_files: dict[Identifier, Patterns] = Field({})
    """The names of answer files for single parts, by part id."""

    @model_validator(mode="after")
    def _names_one_exercise(self) -> "AssignedExerciseSpec":
        if (self.id is None) == (self.path is None):
            raise ValueError(
                say(
                    'names no exercise; write id = "…" for one of the catalogue, or path = '
                    '"….toml" for one of your own'
                )
                if self.id is None
                else say("has an id and a path; leave one of them out")
            )
        return self


class AssignmentSpec(StrictModel):
    """One assignment file."""

    title: Text
    """The title of the assignment."""
    pass_mark: Annotated[float, Field(ge=0, le=1, strict=True), NotBool] = PASS_MARK
    """The score to pass, from 0 to 1."""
    feedback: FeedbackLevel | None = None
    """The highest feedback level for students: "full", "hints", "verdicts" or "score". Default:
    that of each exercise."""
    variants: Annotated[bool, Field(strict=True)] = False
    """True if each learner gets a variant of their own of each exercise with ``[vary]``."""
    exercises: Annotated[list[AssignedExerciseSpec], Field(min_length=1, max_length=MAX_EXERCISES)]
    """The exercises, one ``[[exercises]]`` for each."""


@dataclass(frozen=True, slots=True)
class AssignedExercise:
    """An exercise of an assignment, with only the assigned parts."""

    exercise: SetExercise
    # Its number of points in the assignment.
    worth: float
    # The ids of the parts that are not assigned.
    left_out: frozenset[str] = frozenset()
    # The exercise file, if it is not in the catalogue.
    path: Path | None = None
    # Patterns of the names of answer files. Without patterns, the ids of the exercise and its parts
    # are the names.
    files: tuple[str, ...] = ()
    part_files: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def only_part(self) -> str | None:
        """The id of the only assigned part; None if there are several."""
        parts = self.exercise.parts
        return parts[0].id if len(parts) == 1 else None

    def part_named(self, name: str) -> str | None:
        """The id of the part with this name, ignoring case; None if there is no such part."""
        lowered = name.lower()
        return next((part.id for part in self.exercise.parts if part.id == lowered), None)


@dataclass(frozen=True, slots=True)
class Assignment:
    """The exercises for one hand-in, in order; a single exercise is also an assignment.

    With ``variants``, each learner gets personal variants of the exercises.
    """

    exercises: tuple[AssignedExercise, ...]
    title: str = ""
    pass_mark: float = PASS_MARK
    # The highest feedback level for students; None means the level of each exercise.
    feedback: FeedbackLevel | None = None
    variants: bool = False

    def ceiling(self, assigned: AssignedExercise) -> FeedbackLevel:
        """The highest feedback level for students in this exercise."""
        return self.feedback or assigned.exercise.feedback

    @property
    def part_names(self) -> frozenset[str]:
        """The ids of the parts if there is only one exercise; otherwise empty."""
        if len(self.exercises) > 1:
            return frozenset()
        return frozenset(part.id for each in self.exercises for part in each.exercise.parts)


class UnknownPartNameError(LookupError):
    """An exercise has no part of this name; the message suggests the nearest name."""


def of_one(exercise: SetExercise, part: str | None = None, path: Path | None = None) -> Assignment:
    """Return an assignment of one exercise, or of one of its parts. Raises UnknownPartNameError.

    ``path`` is the exercise file, if the exercise is not in the catalogue.
    """
    chosen = replace(assigned(exercise, None if part is None else [part]), path=path)
    return Assignment((chosen,), exercise.title)


def assigned(
    exercise: SetExercise, parts: list[str] | None = None, worth: float | None = None
) -> AssignedExercise:
    """Return an exercise for an assignment, with the given parts, or with all its parts.

    ``worth`` is its number of points, by default the sum of the points of its parts. Raises
    UnknownPartNameError.
    """
    known = [part.id for part in exercise.parts]
    for part in parts or ():
        if part not in known:
            meant = nearest(part, known)
            raise UnknownPartNameError(
                paragraph(
                    say("{exercise} has no part {part!r}.", exercise=exercise.id, part=part),
                    say("Did you mean {suggestion!r}?", suggestion=meant) if meant else "",
                    say("Its parts are: {parts}.", parts=", ".join(known)),
                )
            )
    chosen = frozenset(known if parts is None else parts)
    restricted = _restricted(exercise, chosen)
    own = sum(part.points for part in restricted.parts)
    return AssignedExercise(restricted, own if worth is None else worth, frozenset(known) - chosen)


def _restricted(exercise: SetExercise, chosen: frozenset[str]) -> SetExercise:
    if isinstance(exercise, ExerciseOutline):
        kept = tuple(part for part in exercise.parts if part.id in chosen)
        return replace(exercise, parts=kept)
    follows: dict[str, str | None] = {}
    parts = []
    for part in exercise.parts:
        followed = part.follows
        if followed is not None and followed not in chosen:
            # The part builds on a dropped part: it builds on that part's predecessor instead.
            followed = follows[followed]
        follows[part.id] = followed
        if part.id in chosen:
            parts.append(part.model_copy(update={"follows": followed}))
    return replace(exercise, parts=tuple(parts))


def load_assignment(file: Path, find: Callable[[str], SetExercise]) -> Assignment:
    """Load an assignment from a TOML file. Raises CatalogueError.

    ``find`` returns the catalogue's exercise with an id, or raises UnknownExerciseError.
    """

    def build(content: dict[str, Any]) -> Assignment:
        spec = AssignmentSpec.model_validate(content)
        exercises, faults = [], []
        for i, each in enumerate(spec.exercises):
            try:
                exercises.append(_assigned(each, f"exercises[{i}]", file.parent, find))
            except FieldError as error:
                faults.append(error)
        if faults:
            raise ExceptionGroup("exercises that cannot be set", faults)
        _check_distinct(exercises)
        return Assignment(
            tuple(exercises), spec.title, spec.pass_mark, spec.feedback, spec.variants
        )

    return load_toml(file, build, _table_at)


def with_seeds(assignment: Assignment, seeds: Mapping[str, str]) -> Assignment:
    """Return the assignment with variants of its exercises. Raises NoVariantError.

    ``seeds`` has the seed of each variant by exercise id.
    """
    exercises = []
    for each in assignment.exercises:
        exercise = each.exercise
        if exercise.id in seeds and isinstance(exercise, Exercise):
            # The variant has the id of the plain exercise.
            variant = hidden_variant(exercise, seeds[exercise.id])
            kept = frozenset(part.id for part in exercise.parts)
            exercises.append(replace(each, exercise=_restricted(variant, kept)))
        else:
            exercises.append(each)
    return replace(assignment, exercises=tuple(exercises))


def _assigned(
    spec: AssignedExerciseSpec, place: str, folder: Path, find: Callable[[str], SetExercise]
) -> AssignedExercise:
    path = folder / spec.path if spec.path is not None else None
    try:
        exercise = load_exercise(path) if path else find(spec.id or "")
    except UnknownExerciseError as error:
        raise FieldError(
            f"{place}.id",
            paragraph(error.args[0], say("Known are: {names}.", names=", ".join(error.known))),
        ) from error
    try:
        chosen = assigned(exercise, spec.parts, spec.points)
    except UnknownPartNameError as error:
        raise FieldError(f"{place}.parts", error.args[0]) from error
    for part in spec.part_files:
        if chosen.part_named(part) is None:
            known = ", ".join(each.id for each in chosen.exercise.parts)
            raise FieldError(
                f"{place}.part_files.{part}",
                say("no part {part!r} is set; those set are: {known}", part=part, known=known),
            )
    return replace(
        chosen,
        path=path,
        files=tuple(spec.files or ()),
        part_files={part: tuple(patterns) for part, patterns in spec.part_files.items()},
    )


def _check_distinct(exercises: Sequence[AssignedExercise]) -> None:
    first: dict[str, int] = {}
    for i, each in enumerate(exercises):
        at = first.setdefault(each.exercise.id, i)
        if at != i:
            raise FieldError(
                f"exercises[{i}]",
                say(
                    "is {exercise!r} again, as exercises[{at}] is; set all its parts there",
                    exercise=each.exercise.id,
                    at=at,
                ),
            )


def _table_at(location: Any) -> type[BaseModel]:
    return AssignedExerciseSpec if location and location[0] == "exercises" else AssignmentSpec


# --- The names of files that learning platforms export, and the students in these names
#
# Moodle (``mod/assign/classes/downloader.php``, earlier ``mod/assign/locallib.php``) names a folder
# ``Ada Byron_1234_assignsubmission_file``, in older versions with another ``_`` at the end, or puts
# the same text before the name of a file. Canvas (``lib/content_zipper.rb``) puts
# ``byronada_LATE_1234_56789_`` before the name of a file. A text that a student typed in Canvas has
# the name ``byronada_1234_text.html``, and a web address has the name ``byronada_1234_link.html``.
# For anonymous students, ``anon_x7Gh2`` replaces the name and the number. Brightspace names a
# folder ``75842-1234567 - Ada Byron - Oct 3, 2026 405 PM``, or puts this text and `` - `` before
# the name of a file. Blackboard names a file ``HW1_abyron_attempt_2026-10-03-16-05-33_table.csv``.

_MOODLE: Final = regex(r"(?P<student>.+?)_(?P<id>\d+)_assignsubmission_[a-z]+(?:_(?P<file>.*))?")
# Canvas removes all but letters, digits and _ from a name; it keeps marks of many scripts.
_CANVAS: Final = regex(
    r"(?:(?P<student>[^\s.,()-]+?)_)??(?:LATE_)?(?P<id>\d{2,}|anon_[A-Za-z0-9]+)"
    r"_(?:\d{3,}_(?P<file>.+)|(?P<entry>(?:text|link)(?:-\d+)?\.html))"
)
# The date has a year, and no `` - ``.
_DATE: Final = r"(?:(?! - ).)*\d{4}(?:(?! - ).)*"
_BRIGHTSPACE: Final = regex(rf"(?P<id>\d+-\d+) ?- ?(?P<student>.+?) ?- {_DATE}(?: - (?P<file>.+))?")
# The text that a student typed has the name of the attempt, without a name of a file.
_BLACKBOARD: Final = regex(
    r"(?P<student>.+_(?P<user>[^_]+))_attempt_\d{4}(?:-\d\d){5}(?:_(?P<file>.+)|(?P<text>\.txt))"
)
# No file system takes a longer name; a zip file does.
_LONGEST: Final = 255
# The name of Blackboard's receipt of an attempt, which holds what the student typed.
RECEIPT: Final = "attempt.txt"
# The number of a second download or a resubmission: ``table-1.csv``, ``table (1).csv``.
_COPY: Final = regex(r"(?:-\d+| ?\(\d+\))$")


@dataclass(frozen=True, slots=True)
class PlatformName:
    """A file name that a learning platform has given, divided into its parts."""

    # Unique.
    student: str
    # The student in the platform's gradebook.
    learner: str
    # The student's own name of the file; empty for a folder.
    file: str
    # The name of the person; empty if the submission is anonymous.
    person: str


def platform_name(name: str) -> PlatformName | None:
    """Split a name that a learning platform has given; return None for other names."""
    if len(name) > _LONGEST:
        return None
    if found := _MOODLE.fullmatch(name):
        # Moodle's grading worksheet has this in the column "Identifier".
        learner = f"Participant {found['id']}"
        student = found["student"]
        return PlatformName(f"{student}_{found['id']}", learner, found["file"] or "", student)
    if found := _BRIGHTSPACE.fullmatch(name):
        student = found["student"]
        return PlatformName(f"{student}_{found['id']}", student, found["file"] or "", student)
    if found := _BLACKBOARD.fullmatch(name):
        user = found["user"]
        return PlatformName(found["student"], user, found["file"] or RECEIPT, user)
    found = _CANVAS.fullmatch(name)
    if found is None or (found["student"] is None) == found["id"].isdigit():
        return None
    student = "_".join(filter(None, (found["student"], found["id"])))
    person = found["student"] or ""
    return PlatformName(student, found["id"], found["file"] or found["entry"], person)


def without_copy_number(stem: str) -> str:
    """Return the name without the number of a copy: ``table`` for ``table (1)``."""
    return _COPY.sub("", stem)


def student_and_part(name: str, parts: Collection[str]) -> tuple[str, str] | None:
    """Split ``STUDENT.PART.csv`` into student and part; return None unless PART is in ``parts``."""
    student, _, part = PurePosixPath(name).stem.rpartition(".")
    part = without_copy_number(part).lower()
    # The name of a student may contain dots; the name of a part does not.
    return (student, part) if student and part in parts else None
