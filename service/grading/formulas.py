"""A value of which only the numbers are known, as the formula that a student would write."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from service.catalogue import Exercise
from service.grading.compare import difference
from service.grading.motion import joint_counts
from service.grading.samples import SAMPLES, Lanes, Samples

EXACT = 1e-9
WHOLE = 1e-6


def formula_text(values: Lanes, angle: bool, exercise: Exercise, samples: Samples) -> str:
    """``values`` ``(LANES,)`` as a sum of multiples of the exercise's letters and a constant.

    That is the form that table cells have: ``theta2 + pi/2``, ``-d2``, ``l1 + l2``. Empty where the
    values are of another form.
    """
    joints = exercise.joints
    counts, linear = joint_counts(values[None], joints, samples, np.array([angle]))
    if not linear[0]:
        return ""
    moving = [joint.variable for joint in joints]
    constant = values - sum(
        n * samples.values[name] for n, name in zip(counts[0], moving, strict=True)
    )
    kind = "angle" if angle else "length"
    letters = [v.name for v in exercise.variables if v.joint is None and v.kind == kind]
    multiples = _multiples(constant, letters, angle, samples)
    if multiples is None:
        return ""
    shares, remainder = multiples
    terms = [*zip(counts[0], moving, strict=True), *zip(shares, letters, strict=True)]
    return _sum(_terms(terms, _constant(remainder, angle)))


def _multiples(
    constant: Lanes, letters: list[str], angle: bool, samples: Samples
) -> tuple[list[int], float] | None:
    """Whole multiples of the letters and a remainder that add up to ``constant``."""
    first = constant[0]
    if np.abs(difference(constant, np.full_like(constant, first), angle)).max() < EXACT:
        return [0] * len(letters), float(first)
    if not letters:
        return None
    letter_values = np.array([samples.values[name][:SAMPLES] for name in letters])
    basis = np.vstack([letter_values, np.ones(SAMPLES)])
    solution = np.linalg.lstsq(basis.T, constant[:SAMPLES], rcond=None)[0]
    shares = np.round(solution[:-1])
    rest = constant[:SAMPLES] - shares @ letter_values
    if np.ptp(rest) > WHOLE:
        return None
    return [int(share) for share in shares], float(rest.mean())


def _constant(value: float, angle: bool) -> str:
    """A number as text; an angle as a fraction of pi where it is one, else in degrees."""
    if not angle:
        return "" if abs(value) < WHOLE else f"{value:.6g}"
    turned = float(difference(np.array(value), np.array(0.0), angle=True))
    if abs(turned) < WHOLE:
        return ""
    share = Fraction(turned / np.pi).limit_denominator(12)
    if abs(float(share) * np.pi - turned) > WHOLE:
        return f"{np.degrees(turned):.6g}deg"
    if share == -1:
        share = Fraction(1)
    top = {1: "pi", -1: "-pi"}.get(share.numerator, f"{share.numerator}*pi")
    return top if share.denominator == 1 else f"{top}/{share.denominator}"


def _terms(multiples: list[tuple[int, str]], constant: str) -> Iterator[str]:
    for count, name in multiples:
        if count:
            yield {1: name, -1: f"-{name}"}.get(int(count), f"{count}*{name}")
    if constant:
        yield constant


def _sum(terms: Iterator[str]) -> str:
    """The terms joined by their signs; 0 where there is none."""
    text = ""
    for term in terms:
        if not text:
            text = term
        elif term.startswith("-"):
            text += f" - {term[1:]}"
        else:
            text += f" + {term}"
    return text or "0"
