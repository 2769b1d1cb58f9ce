"""Check the text of an exercise file in the editor, and preview the exercise."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from service.catalogue import (
    ID_ADVICE,
    CatalogueError,
    Exercise,
    Fault,
    is_exercise_id,
    read_exercise,
)
from service.catalogue.files.lines import line_of, value_lines
from service.formats.shared.plain_text import number
from service.submissions.file_content import MAX_TOML_DOTS
from service.translations import ENGLISH, Language, say, told
from service.translations.sentence import Translation
from service.typeset.statement import statement_html

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
    """Return the findings on an exercise file with this text."""
    # The same as those of ``exercises check``.
    # Imported here, because it loads an algebra system.
    from service.authoring import examine, summary

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
    from service.figures.figure import exercise_figure

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
