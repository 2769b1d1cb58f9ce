"""Find the answers to each exercise of an assignment in the files of a student.

The name of a file says which exercise and part the file answers. Otherwise, the key ``exercise`` in
the file names the exercise.
"""

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from os.path import commonpath
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, Final

from pydantic import ValidationError

from dh_grader.catalogue import Exercise
from dh_grader.catalogue.files import alternatives
from dh_grader.grading.reading.entries import comments, length_unit_of
from dh_grader.regex import regex
from dh_grader.submissions import (
    RECEIPT,
    AssignedExercise,
    Assignment,
    platform_name,
    student_and_part,
    without_copy_number,
)
from dh_grader.submissions.bodies import GradeRequest, nearest
from dh_grader.submissions.documents import (
    Excerpt,
    UnusableFileError,
    changing_remark,
    decoded,
    is_prose,
    shortened,
)
from dh_grader.submissions.files import (
    BY_HAND_ENDINGS,
    DATA_ENDINGS,
    PASTED_ENDINGS,
    FileContent,
    HandedFile,
    HandedIn,
    ending,
    read_content,
    typed_in_receipt,
)
from dh_grader.translations import Sentence, joined, say

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

# The most file names in a message.
_MOST_LISTED: Final = 5
_LONGEST_NAME: Final = 60
# The most files that are tried as the answer to one part.
_MOST_TRIED: Final = 5
# The names of files that are not answers, unless the assignment asks for them.
_NOT_ANSWERS: Final = frozenset({"readme", "license", "licence", "changelog"})
_PROGRAMS: Final = frozenset({".py", ".m", ".ipynb"})
# Files that a repository does not hold for other reasons.
_NO_TEXTS: Final = frozenset(
    {".xlsx", ".xlsm", ".xls", ".ods", ".docx", ".docm", ".rtf", ".csv", ".tsv", ".zip"}
)


@dataclass(frozen=True, slots=True)
class ExerciseAnswers:
    """A student's answers to one exercise, from one or several files."""

    # The path of the file, or of the folder of several files; empty without files.
    file: str
    # None if nothing can be graded.
    body: GradeRequest | None
    # Which files are unusable, and why.
    problem: str = ""
    # The files as the student named them.
    names: tuple[str, ...] = ()
    # A sentence about each file that was not read, by the name of the file.
    unread: Mapping[str, str] = field(default_factory=dict)
    # The paths of the files that were read as answers.
    read: frozenset[Path] = frozenset()
    # The parts that each file answers.
    parts: Mapping[str, frozenset[str]] = field(default_factory=dict)
    # The names of the files that were read except for their pictures.
    with_pictures: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class _Claim:
    file: HandedFile
    part: str | None = None
    # True if the student may have meant this file or another one.
    is_one_of: bool = False


# A function that returns the text of the excerpt that answers a part. May raise UnusableFileError.
Choose = Callable[[AssignedExercise, str, Sequence[Excerpt]], str]


def first_excerpt(_: AssignedExercise, __: str, excerpts: Sequence[Excerpt]) -> str:
    """Return the text of the first excerpt, without grading any."""
    return excerpts[0].text


def answers_in(
    handed: HandedIn, assignment: Assignment, choose: Choose = first_excerpt
) -> tuple[ExerciseAnswers, ...]:
    """Return the answers to each exercise of the assignment, in order.

    If a file has several excerpts, such as the sheets of a workbook, ``choose`` chooses one.
    """
    try:
        everything = list(handed.files())
        files = [file for file in everything if not _is_empty_receipt(file)]
        misplaced = [file for file in files if file.is_misplaced]
        claims, left = _claims(
            [file for file in files if not file.is_misplaced] or files, assignment
        )
    except UnusableFileError as error:
        entries = handed.entries
        file = str(entries[0].path) if len(entries) == 1 else handed.name
        name = entries[0].own_name if len(entries) == 1 else ""
        problem = of_file(name or PurePosixPath(handed.name).name, error.args[0])
        return (ExerciseAnswers(file, None, problem),) * len(assignment.exercises)
    found = [
        _with_misplaced(_combined(own, assigned, choose, handed.name), misplaced)
        for own, assigned in zip(claims, assignment.exercises, strict=True)
    ]
    unread = [file for file in left if _may_be_answer(file)]
    # Where an answer is missing, a photo may be the answer; beside all answers, it is only named.
    return tuple(
        _with_notes(_with_unread(answers, unread, assigned), everything, assigned)
        for answers, assigned in zip(found, assignment.exercises, strict=True)
    )


def _with_misplaced(answers: ExerciseAnswers, misplaced: Sequence[HandedFile]) -> ExerciseAnswers:
    # A file whose path leads out of its zip file is always named: only a person knows whose it is.
    problems = dict(answers.unread)
    for file in misplaced:
        if file.own_name not in problems:
            problems[file.own_name] = of_file(file.own_name, _problem_of(file))
    if len(problems) == len(answers.unread):
        return answers
    names = tuple(file.own_name for file in misplaced if file.own_name not in answers.names)
    return replace(
        answers,
        file=answers.file or str(misplaced[0].path),
        problem=joined(
            "; ", list(filter(None, dict.fromkeys((answers.problem, *problems.values()))))
        ),
        names=(*answers.names, *names),
        unread=problems,
    )


def _with_notes(
    answers: ExerciseAnswers, files: Sequence[HandedFile], assigned: AssignedExercise
) -> ExerciseAnswers:
    # A note beside the answer, such as the text in the editor of the platform, may change it.
    if answers.body is None:
        return answers
    texts = [_text_of(answer) for answer in answers.body.answers.values()]
    unit = _length_unit(assigned)
    for file in files:
        is_answer = file.path in answers.read and file.name != RECEIPT
        if is_answer or not _may_be_note(file, len(files)):
            continue
        said = list(_lines_of(file))
        for text in texts:
            if sentence := changing_remark(text, said, unit):
                problem = of_file(file.own_name, _may_change(sentence))
                return replace(
                    answers,
                    body=None,
                    problem=joined("; ", list(filter(None, (answers.problem, problem)))),
                    names=tuple(dict.fromkeys((*answers.names, file.own_name))),
                    unread={**answers.unread, file.own_name: problem},
                )
    return answers


def _text_of(answer: object) -> str:
    return answer if isinstance(answer, str) else json.dumps(answer, ensure_ascii=False)


def _may_be_note(file: HandedFile, count: int) -> bool:
    # On a platform, each text is the student's. A repository has texts of others, such as README.
    if ending(file.name) not in (*PASTED_ENDINGS, "") or file.problem:
        return False
    if any(map(platform_name, file.path.parts)):
        return True
    return count <= _MOST_TRIED and _stem(file) not in _NOT_ANSWERS


def _lines_of(file: HandedFile) -> Iterator[str]:
    # The sentences in a file, but not the rows of its tables and the statements of its programs.
    try:
        data = file.read()
        if file.name == RECEIPT:
            yield from decoded(data).splitlines()
            return
        found = read_content(data, file.name if ending(file.name) else f"{file.name}.txt")
    except UnusableFileError:
        return
    for excerpt in found.excerpts:
        yield from (*excerpt.around, *excerpt.beside)
        if ending(file.name) in _PROGRAMS:
            yield from (comment[1] for comment in comments(excerpt.text))
        else:
            yield from filter(is_prose, excerpt.text.splitlines())


def _length_unit(assigned: AssignedExercise) -> str | None:
    exercise = assigned.exercise
    return length_unit_of(exercise) if isinstance(exercise, Exercise) else None


def _may_change(sentence: str) -> Sentence:
    return say(
        "has a sentence beside the table or matrix that may change its meaning, so grade "
        "it by hand: “{sentence}”",
        sentence=shortened(sentence),
    )


def _reason(error: Exception) -> str:
    # The ``str`` of an error or a sentence forgets the template of the sentence.
    reason: str = error.args[0]
    return reason


def _problem_of(file: HandedFile) -> str:
    try:
        file.read()
    except UnusableFileError as error:
        return _reason(error)
    return ""


def _with_unread(
    answers: ExerciseAnswers, unread: Sequence[HandedFile], assigned: AssignedExercise
) -> ExerciseAnswers:
    answered = answers.body.answers if answers.body else {}
    known = {part.id.lower(): part.id for part in assigned.exercise.parts}
    if all(part.id in answered for part in assigned.exercise.parts):
        told = [file for file in unread if _is_beside(file, answers)]
        return _with_unread_beside(answers, told, assigned)
    named = [student_and_part(file.name, known) for file in unread]
    # The name of a file may name a part that another file answers.
    unread = [
        file
        for file, found in zip(unread, named, strict=True)
        if found is None or known[found[1]] not in answered
    ]
    if not unread:
        return answers
    problems = dict(answers.unread)
    for file in unread:
        problems[file.own_name] = of_file(file.own_name, _why_unread(file, assigned))
    return replace(
        answers,
        file=answers.file or str(unread[0].path),
        problem=joined("; ", list(problems.values())),
        names=(*answers.names, *(file.own_name for file in unread)),
        unread=problems,
    )


def _is_beside(file: HandedFile, answers: ExerciseAnswers) -> bool:
    # A picture in another folder of a cloned repository belongs to its documentation.
    kind = ending(file.name)
    if kind not in BY_HAND_ENDINGS and kind not in _NO_TEXTS:
        return False
    above = str(file.path.parent)
    return any(map(platform_name, file.path.parts)) or above in (
        answers.file,
        str(PurePosixPath(answers.file).parent),
    )


def _with_unread_beside(
    answers: ExerciseAnswers, files: Sequence[HandedFile], assigned: AssignedExercise
) -> ExerciseAnswers:
    # The answers are graded; the files beside them are named.
    told = {file.own_name: of_file(file.own_name, _why_unread(file, assigned)) for file in files}
    names = tuple(name for name in told if name not in answers.names)
    return replace(answers, names=(*answers.names, *names), unread={**told, **answers.unread})


def _is_empty_receipt(file: HandedFile) -> bool:
    # Blackboard writes a receipt for each attempt, also if the student typed nothing.
    if file.name != RECEIPT or file.problem:
        return False
    try:
        return typed_in_receipt(decoded(file.read())) == ""
    except UnusableFileError:
        return False


def _may_be_answer(file: HandedFile) -> bool:
    # True for a file that may hold an answer, though its name does not say to which part. A cloned
    # repository has other texts and programs; on a platform, a student hands in only answers.
    kind = ending(file.name)
    if _stem(file) in _NOT_ANSWERS:
        return False
    if kind in BY_HAND_ENDINGS or kind in _NO_TEXTS:
        return True
    return kind in PASTED_ENDINGS and any(map(platform_name, file.path.parts))


def _why_unread(file: HandedFile, assigned: AssignedExercise) -> str:
    try:
        read_content(b"" if ending(file.name) in BY_HAND_ENDINGS else file.read(), file.name)
    except UnusableFileError as error:
        return _reason(error)
    return _unnamed(assigned, ending(file.name))


def _claims(
    files: Sequence[HandedFile], assignment: Assignment
) -> tuple[list[list[_Claim]], list[HandedFile]]:
    # The files that answer each exercise, and the files that answer none.
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
        candidates = _candidates(files, assignment)
        i = 0 if len(assignment.exercises) == 1 else _stated(candidates[0], assignment)
        claims[i] += [_Claim(file, is_one_of=len(candidates) > 1) for file in candidates]
    claimed = {id(claim.file) for each in claims for claim in each}
    return claims, [file for file in files if id(file) not in claimed]


def _places(name: str, assignment: Assignment) -> list[tuple[int, str]]:
    path = PurePosixPath(name.lower())
    is_one = len(assignment.exercises) == 1
    found = ((i, _place(path, each, is_one)) for i, each in enumerate(assignment.exercises))
    return [(i, part) for i, part in found if part is not None]


def _place(path: PurePosixPath, assigned: AssignedExercise, is_one: bool) -> str | None:
    for part, patterns in assigned.part_files.items():
        if _is_named(path, patterns):
            return part
    if assigned.files:
        is_named = _is_named(path, assigned.files)
        return (_part_in(path.stem, assigned) or "") if is_named else None
    return _place_by_id(path, assigned, is_one)


def _is_named(path: PurePosixPath, patterns: Sequence[str]) -> bool:
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
    return tuple(dict.fromkeys((stem, without_copy_number(stem))))


def _stated(file: HandedFile, assignment: Assignment) -> int:
    content = read_content(file.read(), file.name)
    known = [each.exercise.id for each in assignment.exercises]
    if content.is_pasted:
        raise UnusableFileError(_unnamed(assignment.exercises[0], ending(file.name)))
    if not isinstance(content.value, dict) or "answers" not in content.value:
        raise UnusableFileError(_no_answers())
    if len(known) == 1:
        return 0
    if "exercise" not in content.value:
        raise UnusableFileError(
            say(
                'does not say which exercise it answers: write "exercise", or name the file after '
                "it, one of {exercises}",
                exercises=_listed(known),
            )
        )
    stated = content.value["exercise"]
    if stated not in known:
        raise UnusableFileError(
            say(
                "answers the exercise {exercise}; those set are {exercises}",
                exercise=_quoted(stated),
                exercises=_listed(known),
            )
        )
    return known.index(stated)


def _candidates(files: Sequence[HandedFile], assignment: Assignment) -> Sequence[HandedFile]:
    """Return the files that may hold the answers: one, or several pasted answers to one part.

    Raises UnusableFileError.
    """
    if not files:
        raise UnusableFileError(say("holds no file"))
    others = [file for file in files if _stem(file) not in _NOT_ANSWERS] or files
    data = [file for file in others if ending(file.name) in DATA_ENDINGS]
    pasted = [file for file in others if ending(file.name) in PASTED_ENDINGS]
    found = data or pasted or others
    asks_one_part = len(assignment.exercises) == 1 and assignment.exercises[0].only_part
    if len(found) == 1 or (found == pasted and asks_one_part and len(found) <= _MOST_TRIED):
        return found
    if all(ending(file.name) in BY_HAND_ENDINGS for file in found):
        raise UnusableFileError(
            say(
                "can only be graded by hand: this program cannot read {files}",
                files=_listed([file.own_name for file in found]),
            )
        )
    raise UnusableFileError(
        say(
            "holds no file whose name says what it answers: there are {files}; name it as "
            "{example}",
            files=_listed([file.own_name for file in files]),
            example=_example(assignment.exercises[0], ending(found[0].name)),
        )
    )


def _stem(file: HandedFile) -> str:
    return PurePosixPath(file.name.lower()).stem


def _unnamed(assigned: AssignedExercise, suffix: str) -> str:
    return say(
        "is a pasted answer, whose name does not say the exercise and the part: name it as "
        "{example}",
        example=_example(assigned, suffix),
    )


def _example(assigned: AssignedExercise, suffix: str) -> str:
    if assigned.files:
        return assigned.files[0]
    if suffix in PASTED_ENDINGS:
        return f"{assigned.exercise.id}/{assigned.exercise.parts[0].id}{suffix}"
    return f"{assigned.exercise.id}.json"


def _combined(
    claims: Sequence[_Claim], assigned: AssignedExercise, choose: Choose, submission: str
) -> ExerciseAnswers:
    if not claims:
        return ExerciseAnswers("", GradeRequest(answers={}))
    paths = [str(claim.file.path) for claim in claims]
    names = tuple(claim.file.own_name for claim in claims)
    shown = paths[0] if len(paths) == 1 else _common_place(paths, submission)
    bodies: list[tuple[str, GradeRequest]] = []
    problems: dict[str, str] = {}
    others: dict[str, str] = {}
    if all(claim.is_one_of for claim in claims):
        try:
            claims, others = _readable_claim(claims, assigned, choose)
        except _DifferentAnswersError as error:
            problem = _reason(error)
            return ExerciseAnswers(shown, None, problem, names, dict.fromkeys(names, problem))
    with_pictures = []
    for claim in claims:
        name = claim.file.own_name
        try:
            content = read_content(claim.file.read(), claim.file.name)
            bodies.append((name, _body(claim, content, assigned, choose)))
            with_pictures += [name] if content.has_pictures else []
        except UnusableFileError as error:
            problems[name] = of_file(name, error.args[0])
    try:
        body = _merged(bodies)
    except UnusableFileError as error:
        # The name of a folder: the student has two answers to a part.
        problem = of_file(PurePosixPath(shown).name, error.args[0])
        return ExerciseAnswers(shown, None, problem, names)
    told = joined("; ", list(problems.values()))
    read = frozenset(claim.file.path for claim in claims)
    parts = {name: frozenset(own.answers) for name, own in bodies}
    return ExerciseAnswers(
        shown, body, told, names, others | problems, read, parts, tuple(with_pictures)
    )


def _common_place(paths: Sequence[str], submission: str) -> str:
    # Files that a platform names after the student are in the folder of the class.
    common = PurePosixPath(commonpath(paths))
    return submission if common in PurePosixPath(submission).parents else str(common)


class _DifferentAnswersError(Exception):
    """Several files have answers to one part; the message is a whole sentence."""


def _merged(bodies: Sequence[tuple[str, GradeRequest]]) -> GradeRequest | None:
    answers: dict[str, Any] = {}
    came_from: dict[str, str] = {}
    options: dict[str, Any] = {}
    for name, body in bodies:
        for part, answer in body.answers.items():
            if part in answers:
                raise UnusableFileError(
                    say(
                        "has two answers to {part}, in {first} and in {second}",
                        part=_quoted(part),
                        first=came_from[part],
                        second=name,
                    )
                )
            answers[part], came_from[part] = answer, name
        for option in body.model_fields_set - {"answers"}:
            value = getattr(body, option)
            if options.setdefault(option, value) != value:
                raise UnusableFileError(
                    say(
                        "has two files that differ in {option!r}: {file} and another",
                        option=option,
                        file=name,
                    )
                )
    return GradeRequest(answers=answers, **options) if bodies else None


def _readable_claim(
    claims: Sequence[_Claim], assigned: AssignedExercise, choose: Choose
) -> tuple[Sequence[_Claim], dict[str, str]]:
    # Of several files that may be the answer to one part, the one that can be graded; and a
    # sentence about each file that cannot be read.
    pieces: list[tuple[_Claim, Excerpt]] = []
    problems: dict[str, str] = {}
    for claim in claims:
        try:
            content = read_content(claim.file.read(), claim.file.name)
        except UnusableFileError as error:
            problems[claim.file.own_name] = of_file(claim.file.own_name, _reason(error))
            continue
        if content.is_pasted:
            own = content.excerpts or (Excerpt(str(content.value)),)
            pieces += [(claim, excerpt) for excerpt in own]
    part = assigned.only_part
    if not pieces or part is None:
        return claims[:1], {}
    try:
        chosen = choose(assigned, part, [excerpt for _, excerpt in pieces])
    except UnusableFileError as error:
        files = list(dict.fromkeys(claim.file.own_name for claim, _ in pieces))
        raise _DifferentAnswersError(
            of_file(files[0], error.args[0])
            if len(files) == 1
            else say(
                "{files} have answers to {part} that differ; leave only one of them",
                files=_listed(files),
                part=part,
            )
        ) from error
    return [next(claim for claim, excerpt in pieces if excerpt.text == chosen)], problems


def _body(
    claim: _Claim, content: FileContent, assigned: AssignedExercise, choose: Choose
) -> GradeRequest:
    part = claim.part or assigned.only_part
    if content.excerpts and part is not None:
        several = len(content.excerpts) > 1
        chosen = choose(assigned, part, content.excerpts) if several else str(content.value)
        _refuse_failed_formulas(chosen)
        refuse_changing_remark(content.excerpts, chosen, assigned)
        content = FileContent(chosen, is_pasted=True)
    elif len(content.excerpts) > 1 and (named := _by_sheet(content.excerpts, assigned)):
        for text in named.values():
            _refuse_failed_formulas(text)
            refuse_changing_remark(content.excerpts, text, assigned)
        content = FileContent({"answers": named})
    return read_body(content, assigned, part)


def _refuse_failed_formulas(chosen: str) -> None:
    # The formula of a spreadsheet may be right although its value could not be computed.
    if found := _FAILED_FORMULA.search(chosen):
        raise UnusableFileError(
            say(
                "has a formula that gave no value ({value}), so grade it by hand",
                value=found[0],
            )
        )


# #NAME?, #REF!, #DIV/0!, #N/A, also in other languages: #BEZUG!, #¿NOMBRE?, #NV; Err:508.
_FAILED_FORMULA: Final = regex(
    r"(?<![^\s,;|\"])(?:#(?:[¿¡]?[A-ZÀ-Ý]{2,10}(?:/0)?[!?]|N/A|NV)|(?:Err|Fehler):[0-9]{3})"
    r"(?![^\s,;|\"])"
)


def refuse_changing_remark(
    excerpts: Sequence[Excerpt], chosen: str, assigned: AssignedExercise
) -> None:
    """Raise UnusableFileError if a sentence beside the chosen text may change its meaning."""
    own = next((each for each in excerpts if each.text == chosen), Excerpt(chosen))
    if own.changed:
        raise UnusableFileError(
            say(
                "changes the table or matrix in a later cell, so grade it by hand: “{statement}”",
                statement=shortened(own.changed),
            )
        )
    if sentence := changing_remark(chosen, own.around, _length_unit(assigned), own.beside):
        raise UnusableFileError(_may_change(sentence))


def _by_sheet(excerpts: Sequence[Excerpt], assigned: AssignedExercise) -> dict[str, str]:
    # The sheets of a workbook that have the names of parts.
    answers: dict[str, str] = {}
    for excerpt in excerpts:
        part = _part_in(excerpt.name.strip(), assigned) if excerpt.name else None
        if part is not None:
            answers.setdefault(part, excerpt.text)
    return answers


def read_body(
    content: FileContent, assigned: AssignedExercise, part: str | None = None
) -> GradeRequest:
    """Read the answers in the content of a file. Raises UnusableFileError.

    ``part`` is the part that the file answers, if known.
    """
    part = part or assigned.only_part
    value = content.value
    if content.is_pasted and part is None:
        names = [f"STUDENT.{each.id}.csv" for each in assigned.exercise.parts]
        raise UnusableFileError(
            say(
                "is the pasted answer to one part: name the file after it, as in {names}, or name "
                "the part with --part",
                names=alternatives(names),
            )
        )
    if content.is_pasted or not isinstance(value, dict) or "answers" not in value:
        if part is None:
            raise UnusableFileError(_no_answers())
        value = {"answers": {part: value}}
    own = assigned.exercise.id
    if (stated := value.get("exercise", own)) != own:
        raise UnusableFileError(
            say(
                "answers the exercise {exercise}, and not {own!r}",
                exercise=_quoted(stated),
                own=own,
            )
        )
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
    return say(
        'holds no "answers"; write {shape}, or name the part that it answers with --part',
        shape='{"answers": {"PART": …}}',
    )


def _first(error: ValidationError) -> str:
    detail = error.errors(include_url=False)[0]
    key = ".".join(str(step) for step in detail["loc"])
    if detail["type"] == "extra_forbidden":
        known = ", ".join(["exercise", *GradeRequest.model_fields])
        return say(
            "has the unknown field {field!r}; the fields are {fields}", field=key, fields=known
        )
    return say("{field} {fault}", field=key, fault=_fault(detail))


def _fault(detail: "ErrorDetails") -> str:
    given = detail["input"]
    shown = json.dumps(given, ensure_ascii=False, default=str)[:_LONGEST_NAME]
    match detail["type"]:
        case "dict_type":
            return say(
                "is {shown}; write {shape}, an answer for each part",
                shown=shown,
                shape='{"PART": …}',
            )
        case "bool_type":
            return say("is {shown}; write true or false", shown=shown)
        case "literal_error":
            known = re.findall("'([^']*)'", detail["ctx"]["expected"])
            meant = nearest(given, known) if isinstance(given, str) else None
            names = ", ".join(known)
            if meant is None:
                return say("is {shown}; it may be {names}", shown=shown, names=names)
            return say(
                "is {shown}; it may be {names}. Did you mean {meant}?",
                shown=shown,
                names=names,
                meant=meant,
            )
    return detail["msg"]


def of_file(name: str, problem: str) -> Sentence:
    """Return a sentence that names a file and its problem."""
    return say("{file} {problem}", file=name, problem=problem)


def _quoted(name: object) -> str:
    return repr(name)[:_LONGEST_NAME]


def _listed(names: Sequence[str]) -> str:
    first = ", ".join(name[:_LONGEST_NAME] for name in names[:_MOST_LISTED])
    more = len(names) - _MOST_LISTED
    return say("{first} and {more} more", first=first, more=more) if more > 0 else first
