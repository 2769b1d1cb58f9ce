"""Table cells as students write them: sums of joint variables, lengths and constants."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, product

import numpy as np

from tests.frame_choice.kinematics import Numbers

SAME = 1e-9


class NotExpressibleError(Exception):
    """The numbers cannot be written as the formula of a cell."""


@dataclass(frozen=True)
class Term:
    """A formula that is not a sum of lengths, such as a root."""

    text: str
    values: Numbers


@dataclass(frozen=True)
class Cell:
    """A table cell: a constant plus multiples of joint variables and lengths."""

    angle: bool
    constant: float = 0.0
    letters: Mapping[str, float] = field(default_factory=dict)
    terms: Mapping[str, float] = field(default_factory=dict)
    variables: Mapping[str, int] = field(default_factory=dict)

    @property
    def is_zero(self) -> bool:
        return not (self.constant or self.letters or self.terms or self.variables)

    @property
    def text(self) -> str:
        """The cell as a formula that both Python and the service can read."""
        named = {**self.variables, **self.letters, **self.terms}
        parts = [_multiple(factor, name) for name, factor in named.items()]
        if self.constant:
            parts.append(_angle(self.constant) if self.angle else _number(self.constant))
        text = "".join(f" - {part[1:]}" if part[0] == "-" else f" + {part}" for part in parts)
        return (f"-{text[3:]}" if text.startswith(" - ") else text[3:]) or "0"


def _number(value: float) -> str:
    return np.format_float_positional(value, precision=12, trim="-")


def _multiple(factor: float, name: str) -> str:
    if abs(factor) == 1:
        return name if factor > 0 else f"-{name}"
    return f"{_number(factor)}*{name}"


def _angle(value: float) -> str:
    degrees = np.degrees(value)
    if abs(degrees - round(degrees)) > SAME:
        return _number(value)
    top, bottom = round(degrees), 180
    shared = int(np.gcd(top, bottom))
    top, bottom = top // shared, bottom // shared
    text = {1: "pi", -1: "-pi"}.get(top, f"{top}*pi")
    return text if bottom == 1 else f"{text}/{bottom}"


def _whole(value: float) -> float:
    return float(np.round(value, 11)) + 0.0


def length_cell(values: Numbers, letters: Mapping[str, Numbers], roots: Sequence[Term]) -> Cell:
    # Return a sum of letters, or a root, that has these values at all K sets of lengths.
    basis = np.array([*letters.values(), np.ones(len(values))]).T
    solution = np.linalg.lstsq(basis, values, rcond=None)[0]
    if np.abs(basis @ solution - values).max() < SAME:
        shares = {name: _whole(share) for name, share in zip(letters, solution, strict=False)}
        return Cell(
            angle=False,
            constant=_whole(solution[-1]),
            letters={name: share for name, share in shares.items() if share},
        )
    for root, sign in product(roots, (1.0, -1.0)):
        if np.abs(values - sign * root.values).max() < SAME:
            return Cell(angle=False, terms={root.text: sign})
    raise NotExpressibleError


def angle_cell(values: Numbers, arcs: Sequence[Term]) -> Cell:
    # Return a constant plus at most two of the arcs that has these values modulo 2π.
    for count in range(3):
        for chosen in combinations(arcs, count):
            for signs in product((1.0, -1.0), repeat=count):
                rest = values - sum(s * arc.values for s, arc in zip(signs, chosen, strict=True))
                turned = _principal(rest - rest[0])
                if np.abs(turned).max() < SAME:
                    constant = _whole(float(_principal(rest[0])))
                    terms = {arc.text: s for s, arc in zip(signs, chosen, strict=True)}
                    return Cell(angle=True, constant=constant, terms=terms)
    raise NotExpressibleError


def _principal(angle: Numbers) -> Numbers:
    turned: Numbers = angle - 2 * np.pi * np.round(angle / (2 * np.pi))
    return turned
