"""Choose the values of a variant by its seed, and put them into the exercise file's content.

The same exercise id and seed give the same values in every process and Python version.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from service.catalogue.robots.formulas import FieldError
from service.catalogue.varying.choices import (
    CONDITIONS,
    DEPLOYED,
    VaryValue,
    choices_of,
    deployed_seeds,
    texts_of,
)
from service.catalogue.varying.conditions import (
    numeric_values,
    read_condition,
    read_formula,
    vocabulary_of,
)
from service.regex import regex
from service.translations import say

# A seed takes the first of these draws that meets all conditions.
_DRAWS: Final = 256
# Draws are checked in groups of this size, because most seeds need one or two.
_GROUP: Final = 16
_PLACE: Final = regex(r"\{\{([^{}]{1,200})\}\}")
# The fields of a file that do not affect grading.
_NOT_GRADING: Final = frozenset({
    "checks", "feedback", "attempts", "view", "level", "order", "minutes", "summary", "keywords",
    "translations",
})  # fmt: skip


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
        graded = {key: value for key, value in self._content.items() if key not in _NOT_GRADING}
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
