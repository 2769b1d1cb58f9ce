"""A compiled exercise: its vocabulary, its reference robot, and its parts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from gettext import NullTranslations
from typing import Final

from service.catalogue.attempts import AttemptsSpec
from service.catalogue.feedback_level import FeedbackLevel
from service.catalogue.files.schema import CheckSpec, PartTextsSpec, TranslationSpec, ViewSpec
from service.catalogue.level import ExerciseLevel
from service.catalogue.part import PartSpec
from service.catalogue.robots.formulas import FormulaField, FormulaGrid, fields_of
from service.catalogue.robots.robot import Joint, Robot
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.robots.variables import Variable
from service.catalogue.varying.vary import Vary
from service.expressions import Vocabulary
from service.kinematics.dh import Convention
from service.translations import ENGLISH, Language, Sentence, told

_ANY_TIME: Final = AttemptsSpec()
_UNTRANSLATED: Final = TranslationSpec()
_UNTRANSLATED_PART: Final = PartTextsSpec()


@dataclass(frozen=True, slots=True)
class Exercise:
    """One exercise of the catalogue.

    ``version`` changes with every field that affects grading. It does not depend on ``checks``,
    ``view``, ``attempts``, ``translations``, ``feedback_by_attempt`` and the fields of the
    catalogue (``level``, ``order``, ``minutes``, ``summary`` and ``keywords``).

    ``feedback_by_attempt`` has the highest feedback level of each attempt; the last level is for
    all later attempts. ``reference`` is the robot, if any; ``formulas`` has, by part id, the
    answers that the file gives. ``length_scale`` is the longest length, to which small differences
    are compared. ``view`` is the viewpoint of the figure. ``vary`` has the values of the variants,
    if the exercise has variants. ``seed`` is the seed of a variant; the variant's ``id`` is
    ``<exercise>~<seed>`` unless the seed is hidden. ``told`` memoizes translations of the exercise
    by language code.
    """

    id: str
    version: str
    title: str
    source: str
    statement: str
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary
    reference: Reference | None
    formulas: Mapping[str, FormulaGrid]
    parts: tuple[PartSpec, ...]
    length_scale: float
    checks: tuple[CheckSpec, ...] = ()
    feedback_by_attempt: tuple[FeedbackLevel, ...] = (FeedbackLevel.HINTS,)
    attempts: AttemptsSpec = _ANY_TIME
    view: ViewSpec | None = None
    level: ExerciseLevel | None = None
    order: int | None = None
    minutes: int | None = None
    summary: str = ""
    keywords: tuple[str, ...] = ()
    vary: Vary | None = None
    seed: str = ""
    translations: Mapping[str, TranslationSpec] = field(default_factory=dict)
    told: dict[str, "Exercise"] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def plain_id(self) -> str:
        """The id of the exercise without the seed of a variant."""
        return self.id.partition("~")[0]

    @property
    def conventions(self) -> tuple[Convention, ...]:
        """The conventions that the parts ask for, without duplicates."""
        asked = {getattr(part, "convention", None) for part in self.parts}
        return tuple(each for each in Convention if not asked.isdisjoint({each, "either"}))

    @property
    def feedback(self) -> FeedbackLevel:
        """The highest feedback level of the first attempt, and of answers that are not recorded."""
        return self.feedback_by_attempt[0]

    def feedback_at(self, ordinal: int) -> FeedbackLevel:
        """The highest feedback level of an attempt; ``ordinal`` counts from 1."""
        return self.feedback_by_attempt[min(ordinal, len(self.feedback_by_attempt)) - 1]

    @property
    def robot(self) -> Robot:
        """The robot given by a table. Raises LookupError if the exercise has no such robot.

        An exercise with a part that asks for a table always has such a robot.
        """
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
        """Yield every formula of the file, with its field in the file and its quantity."""
        if self.reference is not None:
            yield from self.reference.fields()
        for i, part in enumerate(self.parts):
            written = part.formulas()
            if written is not None:
                path, grid = f"parts[{i}].{written.path}", self.formulas[part.id]
                yield from fields_of(path, grid, written.quantities)


def in_language(exercise: Exercise, language: Language) -> Exercise:
    """Return the exercise with its texts in a language; texts without a translation do not change.

    Translations come from the exercise file, or from ``service.translations`` for a ``Sentence``.
    """
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
