"""Find the lengths in a figure that have a name: a symbol, a sum or a number."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from service.catalogue import Variable
from service.catalogue.robots.screw_robot import Reference
from service.catalogue.robots.variables import TRIALS, trial_values
from service.figures.geometry.path import path_of
from service.kinematics.transforms import Numbers

_EXACT = 1e-9


@dataclass(frozen=True, slots=True)
class NamedLength:
    """A piece of the chain's path whose length is the sum of the symbols ``names``.

    ``start`` and ``end`` are indices of corners of ``ChainPath``.
    """

    start: int
    end: int
    names: tuple[str, ...]


def named_lengths(
    reference: Reference, variables: tuple[Variable, ...], statement: str = ""
) -> list[NamedLength]:
    """Return the stretches whose length is a sum of symbols, or a number in the statement."""
    # Students know all symbols of an exercise, so the names reveal nothing.
    turning = {joint.variable for joint in reference.joints if not joint.prismatic}
    values = {
        name: np.zeros(TRIALS) if name in turning else trial
        for name, trial in trial_values(variables).items()
    }
    path = path_of(reference, values, TRIALS)
    lengths = [variable for variable in variables if variable.kind == "length"]
    # A sum begins with the constant symbols: l4 + q4.
    names = [each.name for each in sorted(lengths, key=lambda each: each.joint or 0)]
    terms = np.array([*(values[name] for name in names), np.ones(TRIALS)]).T
    numbers = _decimals(statement)
    found = []
    for i, step in enumerate(np.diff(path.corners, axis=0)):
        share = _sum_of(step, terms)
        if share is not None:
            whole = tuple(name for name, each in zip(names, share, strict=False) if each)
            found.append(NamedLength(i, i + 1, whole))
        elif number := _stated(step, numbers):
            found.append(NamedLength(i, i + 1, (number,)))
    return found


def _decimals(statement: str) -> dict[str, float]:
    return {found: float(found) for found in re.findall(r"(?<![\w.])\d+\.\d+", statement)}


def _stated(step: Numbers, numbers: Mapping[str, float]) -> str | None:
    # Only for a piece of constant length.
    length = np.linalg.norm(step, axis=1)
    return next((text for text, n in numbers.items() if np.abs(length - n).max() < _EXACT), None)


def _sum_of(step: Numbers, terms: Numbers) -> Numbers | None:
    # A 0 or 1 for each term, so that the sum is the piece's length; None if impossible.
    length = np.linalg.norm(step, axis=1)
    solved = np.linalg.lstsq(terms, length, rcond=None)[0]
    share = np.asarray(np.round(solved), dtype=np.float64)
    exact = np.abs(terms @ share - length).max() < _EXACT
    plain = share.any() and not share[-1] and set(share.tolist()) <= {0.0, 1.0}
    return share if exact and plain else None
