"""The possible values of each name in ``[vary]``: a list, or a range with a step."""

import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Final, TypeAlias

from service.catalogue.files.fields import IDENTIFIER
from service.catalogue.robots.formulas import FieldError
from service.regex import regex
from service.translations import say, say_count

# A number or text, or a group of them: {{side.sign}} is the field ``sign`` of the group ``side``.
VaryValue: TypeAlias = Decimal | str | Mapping[str, Decimal | str]

CONDITIONS: Final = "conditions"
DEPLOYED: Final = "deployed"
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
