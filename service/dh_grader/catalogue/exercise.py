"""A compiled exercise: its vocabulary, its reference robot, and its parts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from gettext import NullTranslations
from typing import Final

from dh_grader.catalogue.part import PartSpec
from dh_grader.catalogue.robot import (
    FormulaField,
    FormulaGrid,
    Joint,
    Reference,
    Robot,
    Variable,
    fields_of,
)
from dh_grader.catalogue.schema import CheckSpec, PartTextsSpec, TranslationSpec, ViewSpec
from dh_grader.catalogue.schema_fields import AttemptsSpec, ExerciseLevel, FeedbackLevel
from dh_grader.catalogue.varying import Vary
from dh_grader.expressions import Vocabulary
from dh_grader.kinematics import Convention
from dh_grader.translations import ENGLISH, Language, Sentence, told

_ANY_TIME: Final = AttemptsSpec()
_UNTRANSLATED: Final = TranslationSpec()
_UNTRANSLATED_PART: Final = PartTextsSpec()


@dataclass(frozen=True, slots=True)
class Exercise:
    """An exercise of the catalogue, or a variant with changed numbers."""

    id: str
    # The version changes with every field that affects grading.
    version: str
    title: str
    source: str
    statement: str
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary
    # The robot, if any.
    reference: Reference | None
    # The answers that the file gives, by part id.
    formulas: Mapping[str, FormulaGrid]
    parts: tuple[PartSpec, ...]
    # The longest length, to which small differences are compared.
    length_scale: float
    checks: tuple[CheckSpec, ...] = ()
    # The highest feedback level of each attempt; the last level is for all later attempts.
    feedback_by_attempt: tuple[FeedbackLevel, ...] = (FeedbackLevel.HINTS,)
    attempts: AttemptsSpec = _ANY_TIME
    # The viewpoint of the figure.
    view: ViewSpec | None = None
    level: ExerciseLevel | None = None
    order: int | None = None
    minutes: int | None = None
    summary: str = ""
    keywords: tuple[str, ...] = ()
    # The values of the variants, if the exercise has variants.
    vary: Vary | None = None
    # The seed of a variant, whose id is ``<exercise>~<seed>`` unless the seed is hidden.
    seed: str = ""
    translations: Mapping[str, TranslationSpec] = field(default_factory=dict)
    # Translations of the exercise by language code, memoized.
    told: dict[str, "Exercise"] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def plain_id(self) -> str:
        """The id without the seed of a variant: ``arm`` for the variant ``arm~7``."""
        return self.id.partition("~")[0]

    @property
    def conventions(self) -> tuple[Convention, ...]:
        """The Denavit-Hartenberg conventions that the parts ask for, without duplicates."""
        asked = {getattr(part, "convention", None) for part in self.parts}
        return tuple(each for each in Convention if not asked.isdisjoint({each, "either"}))

    @property
    def feedback(self) -> FeedbackLevel:
        """The highest feedback level for a first attempt or an unrecorded answer."""
        return self.feedback_by_attempt[0]

    def feedback_at(self, ordinal: int) -> FeedbackLevel:
        """The highest feedback level for attempt number ``ordinal``, counted from 1."""
        return self.feedback_by_attempt[min(ordinal, len(self.feedback_by_attempt)) - 1]

    @property
    def robot(self) -> Robot:
        """The robot, if the file gives it by a table. Otherwise raises LookupError."""
        if not isinstance(self.reference, Robot):
            raise LookupError(f"exercise {self.id!r} has no robot with a table")
        return self.reference

    @property
    def symbols(self) -> frozenset[str]:
        """The names of the exercise's variables and symbols, as they are declared."""
        return frozenset(variable.name for variable in self.variables)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The robot's joints; empty without a robot."""
        return self.reference.joints if self.reference else ()

    @property
    def structure(self) -> str | None:
        """The letters of the robot's joints, such as "RRP"; None without a robot."""
        return self.reference.structure if self.reference else None

    def part(self, part_id: str) -> PartSpec | None:
        """The part with this id, or None."""
        return next((part for part in self.parts if part.id == part_id), None)

    def fields(self) -> Iterator[FormulaField]:
        """Yield each formula of the file with its field and quantity (length, angle or number)."""
        if self.reference is not None:
            yield from self.reference.fields()
        for i, part in enumerate(self.parts):
            written = part.formulas()
            if written is not None:
                path, grid = f"parts[{i}].{written.path}", self.formulas[part.id]
                yield from fields_of(path, grid, written.quantities)


def in_language(exercise: Exercise, language: Language) -> Exercise:
    """Return the exercise in a language. Texts without a translation do not change."""
    if language == ENGLISH:
        return exercise
    if language.code not in exercise.told:
        exercise.told[language.code] = _translated(exercise, language)
    return exercise.told[language.code]


def _translated(exercise: Exercise, language: Language) -> Exercise:
    texts = exercise.translations.get(language.code, _UNTRANSLATED)
    translation = language.translation
    variables = (
        replace(
            each, description=texts.symbols.get(each.name) or told(each.description, translation)
        )
        for each in exercise.variables
    )
    return replace(
        exercise,
        title=texts.title or told(exercise.title, translation),
        source=told(exercise.source, translation),
        summary=texts.summary or told(exercise.summary, translation),
        statement=texts.statement or told(exercise.statement, translation),
        variables=tuple(variables),
        parts=tuple(
            _translated_part(part, texts.parts.get(part.id, _UNTRANSLATED_PART), translation)
            for part in exercise.parts
        ),
    )


def _translated_part(
    part: PartSpec, texts: PartTextsSpec, translation: NullTranslations | None
) -> PartSpec:
    sentences = {
        name: told(text, translation)
        for name, text in (("title", part.title), ("prompt", part.prompt))
        if isinstance(text, Sentence)
    }
    return part.model_copy(update=sentences | texts.model_dump(exclude_none=True))
