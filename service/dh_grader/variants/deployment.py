"""Choose the variants of an exercise that learners get: checked, different, and equally hard."""

import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import astuple, dataclass
from secrets import choice
from typing import Final, TypeAlias

import numpy as np

from dh_grader.authoring import Remark, failed_checks, lazy_answers, lazy_shares, model_answer
from dh_grader.catalogue import Exercise, Robot, grid_values
from dh_grader.kinematics import ALPHA, A, D, Numbers
from dh_grader.regex import regex
from dh_grader.translations import say
from dh_grader.variants import built

# --- Compare variants of an exercise by their robot and by their difficulty


# Numbers of a file have a few decimals; what is closer is the same.
_DECIMALS: Final = 6
_QUARTER: Final = np.pi / 2

# The joints, the axes and the pose at home, and the answers in the file, as rounded numbers.
Form: TypeAlias = tuple[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class VariantDifficulty:
    """Counts of what makes a robot hard.

    ``turns`` counts the twists (α) that are not 0, and ``odd_twists`` those that are not multiples
    of 90°. ``free`` counts the pairs of parallel neighbouring axes.
    """

    # A table of variants shows each count in a column. On parallel axes, a frame may be chosen.

    joints: int = 0
    sliding: int = 0
    turns: int = 0
    odd_twists: int = 0
    lengths: int = 0
    free: int = 0

    @property
    def score(self) -> int:
        """The difficulty as one number."""
        # It is the sum of the counts; ``odd_twists`` has three times the weight.
        counts: tuple[int, ...] = astuple(self)
        return sum(counts) + 2 * self.odd_twists


def form_of(exercise: Exercise) -> Form:
    """Describe an exercise so that variants with the same answers get equal descriptions."""
    # It does not depend on frames chosen or on texts.
    values = _home(exercise)
    numbers: list[float] = []
    if exercise.reference is not None:
        numbers += exercise.reference.screws(values, 1).ravel().tolist()
        numbers += exercise.reference.frame("tool", values, 1).ravel().tolist()
    moved = {name: value + 0.37 for name, value in values.items()}
    for name in sorted(exercise.formulas):
        numbers += grid_values(exercise.formulas[name], moved, 1).ravel().tolist()
    # The sum makes 0 of −0.
    rounded = tuple(round(number, _DECIMALS) + 0.0 for number in numbers)
    return exercise.structure or "", rounded


def difficulty_of(exercise: Exercise) -> VariantDifficulty:
    """Return what makes an exercise hard."""
    # All counts are 0 without a table.
    if not isinstance(exercise.reference, Robot):
        return VariantDifficulty(joints=len(exercise.joints))
    robot = exercise.reference
    table = robot.tables[robot.convention].values(_home(exercise), 1)[..., 0]
    twists = np.abs(table[:, ALPHA]) % np.pi
    twists = np.minimum(twists, np.pi - twists)
    turned = twists > 10.0**-_DECIMALS
    odd = turned & (np.abs(twists - _QUARTER) > 10.0**-_DECIMALS)
    return VariantDifficulty(
        joints=len(robot.joints),
        sliding=sum(joint.prismatic for joint in robot.joints),
        turns=int((np.abs(table[:, ALPHA]) > 10.0**-_DECIMALS).sum()),
        odd_twists=int(odd.sum()),
        lengths=int((np.abs(table[:, [A, D]]) > 10.0**-_DECIMALS).sum()),
        free=int((~turned).sum()),
    )


def _home(exercise: Exercise) -> dict[str, Numbers]:
    return {
        variable.name: np.array([0.0 if variable.joint is not None else 0.31 + 0.0713 * i])
        for i, variable in enumerate(exercise.variables)
    }


# --- Choose the variants that learners get: checked by a tutor, different, and equally hard


# Draws for each variant that is wanted; then there are too few different ones.
_DRAWS: Final = 40
_LETTERS: Final = "abcdefghijkmnpqrstuvwxyz23456789"
_LENGTH: Final = 8
_TABLE: Final = regex(r"^\[vary\][ \t]*(?:#[^\n]*)?\n", re.MULTILINE)
_DEPLOYED: Final = regex(r"^deployed[ \t]*=[ \t]*\[[^\]]*\][ \t]*(?:#[^\n]*)?\n", re.MULTILINE)
_PER_LINE: Final = 8


@dataclass(frozen=True, slots=True)
class CheckedVariant:
    """A variant of an exercise, its difficulty, and the remarks of the checks.

    ``form`` describes its robot, to find equal variants. ``lazy`` is the number of points for an
    answer of only zeros and joint variables.
    """

    seed: str
    title: str
    form: Form
    difficulty: VariantDifficulty
    lazy: float
    remarks: tuple[Remark, ...]


class TooFewVariantsError(ValueError):
    """There are not enough different variants of equal difficulty."""

    # The message is for the tutor.


def checked_variant(exercise: Exercise, seed: str) -> CheckedVariant:
    """Return the variant of a seed with the result of its checks.

    Raises NoVariantError.
    """
    variant = built(exercise, seed)
    shares = lazy_shares(variant)
    lazy = sum(shares[part.id] * part.points for part in variant.parts)
    checks = (model_answer, failed_checks, lazy_answers)
    remarks = tuple(remark for check in checks for remark in check(variant))
    return CheckedVariant(
        seed, variant.title, form_of(variant), difficulty_of(variant), lazy, remarks
    )


def random_seeds() -> Iterator[str]:
    """Yield random seeds (short texts that determine variants) without end."""
    # They have no letters that look alike.
    while True:
        yield "".join(choice(_LETTERS) for _ in range(_LENGTH))


def deploy(
    exercise: Exercise,
    count: int,
    without: Iterable[str] = (),
    seeds: Iterator[str] | None = None,
) -> list[str]:
    """Return the seeds of ``count`` different variants with the same difficulty.

    Seeds in ``without`` are not used. Raises TooFewVariantsError or NoVariantError.
    """
    # Deployed seeds of the file are kept if they are usable.
    struck = set(without)
    kept = exercise.vary.deployed if exercise.vary is not None else ()
    wanted = [seed for seed in kept if seed not in struck]
    drawn = random_seeds() if seeds is None else seeds
    forms: dict[Form, str] = {}
    scores: dict[str, int] = {}
    levels: Counter[int] = Counter()
    # The level of the seeds that stay, else the first level with enough variants.
    level: int | None = None
    for i, seed in enumerate(_then(wanted, drawn)):
        if i >= len(wanted) + _DRAWS * count:
            break
        if seed in struck or seed in scores:
            continue
        variant = built(exercise, seed)
        form = form_of(variant)
        if form in forms:
            continue
        forms[form] = seed
        scores[seed] = score = difficulty_of(variant).score
        levels[score] += 1
        if level is None and wanted:
            level = score
        if levels[score] == count and level in (None, score):
            return [seed for seed, own in scores.items() if own == score]
    most = levels[level] if level is not None else max(levels.values(), default=0)
    raise TooFewVariantsError(
        say(
            "{exercise} has only {most} different variants of one difficulty among {draws} draws; "
            "vary more, or deploy {most} at most.",
            exercise=exercise.plain_id,
            most=most,
            draws=_DRAWS * count,
        )
    )


def with_deployed(text: str, seeds: Sequence[str]) -> str | None:
    """Return an exercise file's text with these seeds deployed; None if this is impossible."""
    # Comments and everything else stay as they are.
    place = _TABLE.search(text)
    if place is None:
        return None
    before, after = text[: place.end()], text[place.end() :]
    lines = [", ".join(f'"{each}"' for each in group) for group in _groups(seeds)]
    written = "deployed = [\n" + "".join(f"    {line},\n" for line in lines) + "]\n"
    old = _DEPLOYED.search(after)
    if old is None:
        changed = before + written + after
    else:
        changed = before + after[: old.start()] + written + after[old.end() :]
    wanted = tomllib.loads(text)
    wanted["vary"]["deployed"] = list(seeds)
    try:
        return changed if tomllib.loads(changed) == wanted else None
    except tomllib.TOMLDecodeError:
        return None


def _then(first: Sequence[str], more: Iterator[str]) -> Iterator[str]:
    yield from first
    yield from more


def _groups(seeds: Sequence[str]) -> Iterator[Sequence[str]]:
    for start in range(0, len(seeds), _PER_LINE):
        yield seeds[start : start + _PER_LINE]
