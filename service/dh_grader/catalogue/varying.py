"""The table ``[vary]``: the values that a seed chooses, the possible ones, and conditions.

It fills a file's content with values; what the content means is for ``exercise.py``.
"""

import hashlib
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue.robot import FieldError
from dh_grader.catalogue.schema_fields import IDENTIFIER, NOT_GRADING
from dh_grader.expressions import Expression, ExpressionError, Symbol, Vocabulary, read
from dh_grader.regex import regex
from dh_grader.translations import say, say_count

# --- Choose the values of a variant by its seed, and put them into the exercise file's content
#
# The same exercise id and seed give the same values in every process and Python version.


# A number or text, or a group of them: {{side.sign}} is the field ``sign`` of the group ``side``.
VaryValue: TypeAlias = Decimal | str | Mapping[str, Decimal | str]

# The keys of ``[vary]`` that are not names.
CONDITIONS: Final = "conditions"
DEPLOYED: Final = "deployed"
# A seed takes the first of these draws that meets all conditions.
_DRAWS: Final = 256
# Draws are checked in groups of this size, because most seeds need one or two.
_GROUP: Final = 16
_PLACE: Final = regex(r"\{\{([^{}]{1,200})\}\}")


class Vary:
    """An exercise file's content with a table ``[vary]``, from which variants are made."""

    def __init__(self, exercise_id: str, content: Mapping[str, Any]) -> None:
        """Read the table ``vary`` of a file's content. Raises FieldError."""
        written = content["vary"]
        if not isinstance(written, dict):
            raise FieldError("vary", say("must be a table; write [vary]"))
        # The table as written.
        self.table: Mapping[str, Any] = written
        self._id = exercise_id
        self._content = {key: value for key, value in content.items() if key != "vary"}
        self._choices = choices_of(written)
        # The only seeds for assignments; if there are none, assignments use any seed.
        self.deployed = deployed_seeds(written)
        numbers = {name: numeric_values(values) for name, values in self._choices.items()}
        self._numbers = {name: found for name, found in numbers.items() if found is not None}
        self._vocabulary = vocabulary_of(list(self._numbers))
        self._conditions = [
            read_condition(f"vary.{CONDITIONS}[{i}]", text, self._vocabulary)
            for i, text in enumerate(texts_of(written, CONDITIONS))
        ]
        first = dict.fromkeys(self._choices, 0)
        chosen = first if self._meet([first])[0] else self._draw("")
        if chosen is None:
            reason = say(
                "no one of {count} draws meets all conditions; allow more choices", count=_DRAWS
            )
            raise FieldError(f"vary.{CONDITIONS}", reason)
        # The exercise without a seed has the first choices if they meet the conditions.
        self._plain = chosen
        # The version changes with every field that affects grading, in any variant.
        graded = {key: value for key, value in self._content.items() if key not in NOT_GRADING}
        kept = {key: value for key, value in written.items() if key != DEPLOYED}
        self.base_version = _digest({**graded, "vary": kept}, 6)

    def with_choices(self, table: Mapping[str, Any]) -> "Vary":
        """Return the file's content with the table ``[vary]`` from an earlier version of the file.

        Raises FieldError if the file's texts do not fit that table.
        """
        try:
            earlier = Vary(self._id, {**self._content, "vary": table})
            earlier.content(earlier.values(""))
        # If a text needs a name that the earlier table lacks, the name keeps its present choices.
        except FieldError:
            rules = (CONDITIONS, DEPLOYED)
            present = {name: each for name, each in self.table.items() if name not in rules}
            earlier = Vary(self._id, {**self._content, "vary": {**present, **table}})
            earlier.content(earlier.values(""))
        earlier.base_version = self.base_version
        return earlier

    @property
    def count(self) -> int:
        """The number of combinations of choices, including those that the conditions exclude."""
        count = 1
        for values in self._choices.values():
            count *= len(values)
        return count

    def values(self, seed: str) -> Mapping[str, VaryValue]:
        """Return the value of each name in the variant of a seed; "" means the exercise itself."""
        # A seed whose values never meet the conditions also gives the values of the plain exercise.
        chosen = (self._draw(seed) if seed else None) or self._plain
        return {name: self._choices[name][i] for name, i in chosen.items()}

    def written(self, seed: str) -> Mapping[str, str]:
        """Return the values in the variant of a seed as text, by name."""
        written: dict[str, str] = {}
        for name, value in self.values(seed).items():
            if isinstance(value, Mapping):
                written |= {f"{name}.{key}": _text(each) for key, each in value.items()}
            else:
                written[name] = _text(value)
        return written

    def version(self, values: Mapping[str, VaryValue]) -> str:
        """Return a variant's version: the version of the file, and a digest of the values."""
        return f"{self.base_version}-{values_digest(values)}"

    def content(self, values: Mapping[str, VaryValue]) -> dict[str, Any]:
        """Return the file's content with these values filled into all texts. Raises FieldError."""
        return dict(self._filled(self._content, values, ""))

    def _draw(self, seed: str) -> Mapping[str, int] | None:
        for start in range(0, _DRAWS, _GROUP):
            draws = [
                {
                    name: _whole(f"{self._id}~{seed}/{draw}/{name}", len(values))
                    for name, values in self._choices.items()
                }
                for draw in range(start, start + (_GROUP if self._conditions else 1))
            ]
            good = self._meet(draws)
            if good.any():
                return draws[int(np.argmax(good))]
        return None

    def _meet(self, draws: Sequence[Mapping[str, int]]) -> NDArray[np.bool_]:
        values = {
            name: np.array([numbers[draw[name]] for draw in draws])
            for name, numbers in self._numbers.items()
        }
        good = np.ones(len(draws), np.bool_)
        for condition in self._conditions:
            good &= condition.holds(values, len(draws))
        return good

    def _filled(self, node: Any, values: Mapping[str, VaryValue], field: str) -> Any:
        match node:
            case str():
                return _PLACE.sub(lambda place: self._written(place[1], values, field), node)
            case dict():
                return {
                    self._filled(key, values, field): self._filled(
                        value, values, f"{field}.{key}" if field else key
                    )
                    for key, value in node.items()
                }
            case list():
                return [
                    self._filled(value, values, f"{field}[{i}]") for i, value in enumerate(node)
                ]
            case _:
                return node

    def _written(self, place: str, values: Mapping[str, VaryValue], field: str) -> str:
        place = place.strip()
        name, dot, key = place.partition(".")
        found = values.get(name)
        if isinstance(found, Mapping):
            if key not in found:
                keys = ", ".join(f"{name}.{each}" for each in found)
                raise FieldError(
                    field,
                    say("there is no {{{{{place}}}}}; write one of {keys}", place=place, keys=keys),
                )
            return _text(found[key])
        if found is not None and not dot:
            return _text(found)
        formula = read_formula(field, place, self._vocabulary)
        numbers = {
            each: np.array([self._numbers[each][self._choices[each].index(values[each])]])
            for each in formula.symbols
        }
        result = float(np.broadcast_to(formula.evaluate(numbers), 1)[0])
        if not np.isfinite(result):
            raise FieldError(
                field, say("{{{{{place}}}}} has no value for some of the choices", place=place)
            )
        return _text(Decimal(f"{result:.9g}"))


def values_digest(values: Mapping[str, VaryValue]) -> str:
    """Return a short digest of the values of a variant."""
    return _digest({name: _plain(value) for name, value in values.items()}, 4)


def _plain(value: VaryValue) -> object:
    if isinstance(value, Mapping):
        return {name: _text(each) for name, each in value.items()}
    return _text(value)


def _text(value: VaryValue) -> str:
    if not isinstance(value, Decimal):
        return str(value)
    written = format(value, "f")
    written = written.rstrip("0").rstrip(".") if "." in written else written
    return "0" if written == "-0" else written


def _whole(text: str, count: int) -> int:
    # Each value has its own digest, so a new name in ``[vary]`` changes no other value.
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") % count


def _digest(content: object, size: int) -> str:
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.blake2b(text.encode(), digest_size=size).hexdigest()


# --- The possible values of each name in ``[vary]``: a list, or a range with a step


MOST_NAMES: Final = 40
MOST_CHOICES: Final = 1000
MOST_DEPLOYED: Final = 500
_NAME: Final = regex(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*")
_RANGE: Final = ("from", "to", "step")
_EXPECTED: Final = say(
    "write a list of choices, such as [0.3, 0.4, 0.5], or a range, such as "
    "{{ from = 0.2, to = 0.6, step = 0.1 }}"
)


def choices_of(vary: Mapping[str, object]) -> dict[str, Sequence[VaryValue]]:
    """Return the possible values of each name. Raises FieldError."""
    found: dict[str, Sequence[VaryValue]] = {}
    for name, written in vary.items():
        if name in (CONDITIONS, DEPLOYED):
            continue
        field = f"vary.{name}"
        if not _NAME.fullmatch(name):
            raise FieldError(field, say("is no name; write letters and digits, such as a1"))
        found[name] = _choices(field, written)
    if not found:
        raise FieldError("vary", say("varies nothing; {expected}", expected=_EXPECTED))
    if len(found) > MOST_NAMES:
        raise FieldError(
            "vary",
            say("has {count} names; write at most {most}", count=len(found), most=MOST_NAMES),
        )
    return found


def texts_of(vary: Mapping[str, object], key: str) -> Sequence[str]:
    """Return the list of texts under ``key``, or an empty list. Raises FieldError."""
    written = vary.get(key, [])
    if not isinstance(written, list) or not all(isinstance(each, str) for each in written):
        raise FieldError(f"vary.{key}", say('must be a list of texts; write ["…", "…"]'))
    return written


def is_seed(text: str) -> bool:
    """True if ``text`` can be a seed: 1 to 20 small letters and digits."""
    return re.fullmatch("[a-z0-9]{1,20}", text) is not None


def deployed_seeds(vary: Mapping[str, object]) -> tuple[str, ...]:
    """Return the seeds (short texts that determine variants) that assignments may use.

    Raises FieldError.
    """
    seeds = texts_of(vary, DEPLOYED)
    if len(seeds) > MOST_DEPLOYED:
        raise FieldError(
            f"vary.{DEPLOYED}", say("has too many seeds; write at most {most}", most=MOST_DEPLOYED)
        )
    for i, seed in enumerate(seeds):
        if not is_seed(seed):
            reason = say("is no seed; write 1 to 20 small letters and digits")
            raise FieldError(f"vary.{DEPLOYED}[{i}]", reason)
        if seed in seeds[:i]:
            raise FieldError(
                f"vary.{DEPLOYED}[{i}]", say("{seed} is there twice; leave one out", seed=seed)
            )
    return tuple(seeds)


def _choices(field: str, written: object) -> Sequence[VaryValue]:
    if isinstance(written, dict):
        return _range(field, written)
    if not isinstance(written, list):
        raise FieldError(field, say("is not a list; {expected}", expected=_EXPECTED))
    if not 2 <= len(written) <= MOST_CHOICES:
        raise FieldError(
            field,
            say_count(
                "has one value; write 2 to {most}",
                "has {count} values; write 2 to {most}",
                count=len(written),
                most=MOST_CHOICES,
            ),
        )
    values = [_value(f"{field}[{i}]", each) for i, each in enumerate(written)]
    fields = [set(each) if isinstance(each, Mapping) else None for each in values]
    for i, each in enumerate(fields):
        if each != fields[0]:
            reason = say("must have the same keys as the first choice")
            raise FieldError(f"{field}[{i}]", reason)
    return values


def _value(field: str, written: object) -> VaryValue:
    if isinstance(written, dict):
        group: dict[str, Decimal | str] = {}
        for name, each in written.items():
            if not re.fullmatch(IDENTIFIER, name):
                raise FieldError(
                    f"{field}.{name}", say("is no name; write small letters and digits")
                )
            group[name] = _simple(f"{field}.{name}", each)
        return group
    return _simple(field, written)


def _simple(field: str, written: object) -> Decimal | str:
    if isinstance(written, str):
        return written
    return _number(field, written)


def _number(field: str, written: object) -> Decimal:
    if isinstance(written, bool) or not isinstance(written, int | float):
        raise FieldError(field, say("must be a number or a text"))
    number = Decimal(str(written))
    if not number.is_finite() or abs(number) > 10**9:
        raise FieldError(field, say("is too large; write a number up to 1e9"))
    return number


def _range(field: str, written: Mapping[str, object]) -> Sequence[Decimal]:
    for name in written:
        if name not in _RANGE:
            raise FieldError(
                f"{field}.{name}", say("there is no such key; a range has from, to, step")
            )
    for name in _RANGE:
        if name not in written:
            raise FieldError(
                field, say("needs {name}; write {{ from = …, to = …, step = … }}", name=name)
            )
    low, high, step = (_number(f"{field}.{name}", written[name]) for name in _RANGE)
    if not (low < high and step > 0):
        raise FieldError(field, say("must rise: write from below to, and a step above 0"))
    count = int((high - low) / step) + 1
    if not 2 <= count <= MOST_CHOICES:
        reason = say("has {count:,} values; write 2 to {most}", count=count, most=MOST_CHOICES)
        raise FieldError(f"{field}.step", reason)
    return [low + i * step for i in range(count)]


# --- The conditions in ``[vary]``: comparisons of formulas with the varied numbers


# Signs of two characters come first.
_SIGN: Final = regex("<=|>=|!=|==|[<>=≤≥≠]")
# Numbers in a file have a few decimals: a difference below this is rounding.
_EQUAL: Final = 1e-9


def numeric_values(values: Sequence[VaryValue]) -> Sequence[float] | None:
    """Return the choices as numbers, or None if one of them is not a number."""
    found = []
    for each in values:
        if isinstance(each, Mapping):
            return None
        if isinstance(each, Decimal):
            found.append(float(each))
            continue
        try:
            found.append(float(read(each, Vocabulary([])).evaluate({})))
        except ExpressionError:
            return None
    return found


def vocabulary_of(names: Sequence[str]) -> Vocabulary:
    """Return the symbols for formulas: the names whose choices are numbers. Raises FieldError."""
    for name in names:
        try:
            Vocabulary([Symbol(name, "number")])
        except ValueError as error:
            raise FieldError(f"vary.{name}", error.args[0]) from error
    try:
        return Vocabulary([Symbol(name, "number") for name in names])
    except ValueError as error:
        raise FieldError("vary", error.args[0]) from error


def read_formula(field: str, text: str, vocabulary: Vocabulary) -> Expression:
    """Read a formula in which every symbol is the name of a varied number. Raises FieldError."""
    try:
        return read(text, vocabulary)
    except ExpressionError as error:
        raise FieldError(field, error.message) from error


_Comparison: TypeAlias = Callable[[NDArray[np.float64]], NDArray[np.bool_]]
# Whether a difference of two sides fits a sign.
_COMPARED: Final[Mapping[str, _Comparison]] = {
    "<": lambda difference: difference < -_EQUAL,
    ">": lambda difference: difference > _EQUAL,
    **dict.fromkeys(("<=", "≤"), lambda difference: difference <= _EQUAL),
    **dict.fromkeys((">=", "≥"), lambda difference: difference >= -_EQUAL),
    **dict.fromkeys(("=", "=="), lambda difference: np.abs(difference) <= _EQUAL),
    **dict.fromkeys(("!=", "≠"), lambda difference: np.abs(difference) > _EQUAL),
}


@dataclass(frozen=True, slots=True)
class Condition:
    """A comparison of two formulas."""

    left: Expression
    sign: str
    right: Expression

    def holds(self, values: Mapping[str, NDArray[np.float64]], count: int) -> NDArray[np.bool_]:
        """Return a mask that is True where the values meet the condition."""
        difference = np.broadcast_to(
            np.asarray(self.left.evaluate(values)) - np.asarray(self.right.evaluate(values)), count
        )
        met: NDArray[np.bool_] = np.isfinite(difference) & _COMPARED[self.sign](difference)
        return met


def read_condition(field: str, text: str, vocabulary: Vocabulary) -> Condition:
    """Return the condition in ``text``. Raises FieldError."""
    signs = _SIGN.findall(text)
    if len(signs) != 1:
        reason = say(
            'must compare two formulas by <, >, <=, >=, = or !=; write, for example, "a1 > a2"'
        )
        raise FieldError(field, reason)
    left, right = (read_formula(field, side, vocabulary) for side in text.split(signs[0]))
    return Condition(left, signs[0], right)
