"""Find the answers to each exercise of an assignment in the files of a student.

The name of a file says which exercise and part it answers. Otherwise its key ``exercise`` says so,
or the assignment has only one exercise.
"""

import json
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from os.path import commonpath
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Final

from pydantic import ValidationError

from service.submissions.assignment import AssignedExercise, Assignment
from service.submissions.body import GradeRequest
from service.submissions.file_content import (
    DATA_ENDINGS,
    PASTED_ENDINGS,
    FileContent,
    UnusableFileError,
    ending,
    read_content,
)
from service.submissions.handed_in import HandedFile, HandedIn
from service.submissions.lookup import nearest
from service.submissions.platform_names import student_and_part, without_copy_number

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

# The most file names in a message.
_MOST_LISTED: Final = 5
_LONGEST_NAME: Final = 60
# The names of files that are not answers, unless the assignment asks for them.
_NOT_ANSWERS: Final = frozenset({"readme", "license", "licence", "changelog"})


@dataclass(frozen=True, slots=True)
class ExerciseAnswers:
    """The answers to one exercise.

    ``file`` is the path of their file, or of the folder of several files; ``names`` are the files
    as the student named them. Both are empty without files. ``body`` is None if nothing can be
    graded. ``problem`` says which files are unusable, and why.
    """

    file: str
    body: GradeRequest | None
    problem: str = ""
    names: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class _Claim:
    """A file that answers an exercise, or only the part in its name."""

    file: HandedFile
    part: str | None = None


def answers_in(handed: HandedIn, assignment: Assignment) -> tuple[ExerciseAnswers, ...]:
    """Return the answers to each exercise of the assignment, in order.

    An exercise without a file has no answers, and no problem if another exercise has a file.
    """
    try:
        claims = _claims(handed.files(), assignment)
    except UnusableFileError as error:
        is_file = len(handed.entries) == 1
        file = str(handed.entries[0].path) if is_file else handed.name
        return (ExerciseAnswers(file, None, str(error)),) * len(assignment.exercises)
    return tuple(map(_combined, claims, assignment.exercises))


def _claims(files: Sequence[HandedFile], assignment: Assignment) -> list[list[_Claim]]:
    """The files that answer each exercise. Raises UnusableFileError if no file answers any."""
    claims: list[list[_Claim]] = [[] for _ in assignment.exercises]
    unnamed = []
    for file in files:
        places = _places(file.name, assignment)
        if len(places) == 1:
            [(i, part)] = places
            claims[i].append(_Claim(file, part or None))
        else:
            unnamed.append(file)
    for file in unnamed:
        if ending(file.name) in DATA_ENDINGS:
            with suppress(UnusableFileError):
                claims[_stated(file, assignment)].append(_Claim(file))
    if not any(claims):
        for file in unnamed:
            if found := student_and_part(file.name, assignment.part_names):
                claims[0].append(_Claim(file, found[1]))
    if not any(claims):
        only = _only_file(files, assignment)
        i = 0 if len(assignment.exercises) == 1 else _stated(only, assignment)
        claims[i].append(_Claim(only))
    return claims


def _places(name: str, assignment: Assignment) -> list[tuple[int, str]]:
    """The exercises that the file name matches, each with the part, or "" for the exercise."""
    path = PurePosixPath(name.lower())
    is_one = len(assignment.exercises) == 1
    found = ((i, _place(path, each, is_one)) for i, each in enumerate(assignment.exercises))
    return [(i, part) for i, part in found if part is not None]


def _place(path: PurePosixPath, assigned: AssignedExercise, is_one: bool) -> str | None:
    """The part in the file name, "" if it names only the exercise, None if it names neither."""
    for part, patterns in assigned.part_files.items():
        if _is_named(path, patterns):
            return part
    if assigned.files:
        is_named = _is_named(path, assigned.files)
        return (_part_in(path.stem, assigned) or "") if is_named else None
    return _place_by_id(path, assigned, is_one)


def _is_named(path: PurePosixPath, patterns: Sequence[str]) -> bool:
    """True if the path, in lower case, matches one of the patterns."""
    return any(path.match(pattern.lower()) for pattern in patterns)


def _place_by_id(path: PurePosixPath, assigned: AssignedExercise, is_one: bool) -> str | None:
    own = assigned.exercise.id
    for stem in _stems(path.stem):
        if stem == own:
            return ""
        rest = stem.removeprefix(own)
        if rest != stem and rest[0] in "._- " and (part := assigned.part_named(rest[1:])):
            return part
    is_inside = own in path.parent.parts
    if (is_one or is_inside) and (part := _part_in(path.stem, assigned)):
        return part
    holds_parts = ending(path.name) in DATA_ENDINGS or assigned.only_part is not None
    return "" if is_inside and holds_parts and path.stem not in _NOT_ANSWERS else None


def _part_in(stem: str, assigned: AssignedExercise) -> str | None:
    return next(filter(None, map(assigned.part_named, _stems(stem))), None)


def _stems(stem: str) -> tuple[str, ...]:
    """The name, and the name without the number of a copy."""
    return tuple(dict.fromkeys((stem, without_copy_number(stem))))


def _stated(file: HandedFile, assignment: Assignment) -> int:
    """The index of the exercise named in the content of a file. Raises UnusableFileError."""
    content = read_content(file.read(), file.name)
    known = [each.exercise.id for each in assignment.exercises]
    if content.is_pasted:
        raise UnusableFileError(
            "is a pasted answer, whose name does not say the exercise and the part: "
            f"name it as {_example(assignment.exercises[0], ending(file.name))}"
        )
    if not isinstance(content.value, dict) or "answers" not in content.value:
        raise UnusableFileError(_no_answers())
    if len(known) == 1:
        return 0
    if "exercise" not in content.value:
        raise UnusableFileError(
            'does not say which exercise it answers: write "exercise", or name the file after it, '
            f"one of {_listed(known)}"
        )
    stated = content.value["exercise"]
    if stated not in known:
        raise UnusableFileError(
            f"answers the exercise {_quoted(stated)}; those set are {_listed(known)}"
        )
    return known.index(stated)


def _only_file(files: Sequence[HandedFile], assignment: Assignment) -> HandedFile:
    """The only file that may have answers. Raises UnusableFileError if there are several."""
    if not files:
        raise UnusableFileError("holds no file")
    others = [file for file in files if _stem(file) not in _NOT_ANSWERS] or files
    data = [file for file in others if ending(file.name) in DATA_ENDINGS]
    pasted = [file for file in others if ending(file.name) in PASTED_ENDINGS]
    candidates = data or pasted or others
    if len(candidates) == 1:
        return candidates[0]
    raise UnusableFileError(
        "holds no file whose name says what it answers: there are "
        f"{_listed([file.own_name for file in files])}; "
        f"name it as {_example(assignment.exercises[0], ending(candidates[0].name))}"
    )


def _stem(file: HandedFile) -> str:
    return PurePosixPath(file.name.lower()).stem


def _example(assigned: AssignedExercise, suffix: str) -> str:
    """An example of a file name for this exercise, with a part if the suffix needs one."""
    if assigned.files:
        return assigned.files[0]
    if suffix in PASTED_ENDINGS:
        return f"{assigned.exercise.id}/{assigned.exercise.parts[0].id}{suffix}"
    return f"{assigned.exercise.id}.json"


def _combined(claims: Sequence[_Claim], assigned: AssignedExercise) -> ExerciseAnswers:
    """The answers of all files to one exercise; an unusable file affects only itself."""
    if not claims:
        return ExerciseAnswers("", GradeRequest(answers={}))
    paths = [str(claim.file.path) for claim in claims]
    names = tuple(claim.file.own_name for claim in claims)
    shown = paths[0] if len(paths) == 1 else commonpath(paths)
    bodies: list[tuple[str, GradeRequest]] = []
    problems = []
    for claim in claims:
        try:
            bodies.append((claim.file.own_name, _body(claim, assigned)))
        except UnusableFileError as error:
            told = str(error) if len(claims) == 1 else f"{claim.file.own_name} {error}"
            problems.append(told)
    try:
        body = _merged(bodies)
    except UnusableFileError as error:
        return ExerciseAnswers(shown, None, str(error), names)
    return ExerciseAnswers(shown, body, "; ".join(problems), names)


def _merged(bodies: Sequence[tuple[str, GradeRequest]]) -> GradeRequest | None:
    """Merge the answers of several files. Raises UnusableFileError if two files contradict."""
    answers: dict[str, Any] = {}
    came_from: dict[str, str] = {}
    options: dict[str, Any] = {}
    for name, body in bodies:
        for part, answer in body.answers.items():
            if part in answers:
                raise UnusableFileError(
                    f"has two answers to {_quoted(part)}, in {came_from[part]} and in {name}"
                )
            answers[part], came_from[part] = answer, name
        for option in body.model_fields_set - {"answers"}:
            value = getattr(body, option)
            if options.setdefault(option, value) != value:
                raise UnusableFileError(
                    f"has two files that differ in {option!r}: {name} and another"
                )
    return GradeRequest(answers=answers, **options) if bodies else None


def _body(claim: _Claim, assigned: AssignedExercise) -> GradeRequest:
    """Read the answers in one file. Raises UnusableFileError."""
    content = read_content(claim.file.read(), claim.file.name)
    return read_body(content, assigned, claim.part)


def read_body(
    content: FileContent, assigned: AssignedExercise, part: str | None = None
) -> GradeRequest:
    """Read the answers to the assigned parts. With ``part``, the content may be just its answer.

    Raises UnusableFileError.
    """
    part = part or assigned.only_part
    value = content.value
    if content.is_pasted and part is None:
        names = " or ".join(f"STUDENT.{each.id}.csv" for each in assigned.exercise.parts)
        raise UnusableFileError(
            f"is the pasted answer to one part: name the file after it, as in {names}, or name the "
            "part with --part"
        )
    if content.is_pasted or not isinstance(value, dict) or "answers" not in value:
        if part is None:
            raise UnusableFileError(_no_answers())
        value = {"answers": {part: value}}
    own = assigned.exercise.id
    if (stated := value.get("exercise", own)) != own:
        raise UnusableFileError(f"answers the exercise {_quoted(stated)}, and not {own!r}")
    try:
        body = GradeRequest.model_validate(
            {key: each for key, each in value.items() if key != "exercise"}
        )
    except ValidationError as error:
        raise UnusableFileError(_first(error)) from error
    answers = {
        name: answer for name, answer in body.answers.items() if name not in assigned.left_out
    }
    return body.model_copy(update={"answers": answers})


def _no_answers() -> str:
    return (
        'holds no "answers"; write {"answers": {"PART": …}}, '
        "or name the part that it answers with --part"
    )


def _first(error: ValidationError) -> str:
    detail = error.errors(include_url=False)[0]
    key = ".".join(str(step) for step in detail["loc"])
    if detail["type"] == "extra_forbidden":
        known = ", ".join(["exercise", *GradeRequest.model_fields])
        return f"has the unknown field {key!r}; the fields are {known}"
    return f"{key} {_fault(detail)}"


def _fault(detail: "ErrorDetails") -> str:
    """The fault of a field in words for students."""
    given = detail["input"]
    shown = json.dumps(given, ensure_ascii=False, default=str)[:_LONGEST_NAME]
    match detail["type"]:
        case "dict_type":
            return f'is {shown}; write {{"PART": …}}, an answer for each part'
        case "bool_type":
            return f"is {shown}; write true or false"
        case "literal_error":
            known = re.findall("'([^']*)'", detail["ctx"]["expected"])
            meant = nearest(given, known) if isinstance(given, str) else None
            hint = f". Did you mean {meant}?" if meant else ""
            return f"is {shown}; it may be {', '.join(known)}{hint}"
    return detail["msg"]


def _quoted(name: object) -> str:
    return repr(name)[:_LONGEST_NAME]


def _listed(names: Sequence[str]) -> str:
    first = ", ".join(name[:_LONGEST_NAME] for name in names[:_MOST_LISTED])
    more = len(names) - _MOST_LISTED
    return f"{first} and {more} more" if more > 0 else first
