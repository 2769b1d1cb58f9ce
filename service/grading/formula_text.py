"""The formula that a student would write for values of which only the numbers are known."""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from service.catalogue import Exercise
from service.grading.comparison import difference
from service.grading.joint_motion import coefficients
from service.grading.samples import HALF, Samples
from service.grading.tolerances import CONSTANT, WHOLE_MULTIPLE
from service.kinematics.transforms import Numbers


def formula_text(values: Numbers, angle: bool, exercise: Exercise, samples: Samples) -> str:
    """``values`` ``(SAMPLES,)`` as a sum of multiples of the exercise's letters and a constant.

    That is the form of table cells: ``theta2 + pi/2``, ``-d2``, ``l1 + l2``. The text is empty if
    the values are of another form.
    """
    (counts,) = coefficients(values[None], exercise.joints, samples, np.array([angle]))
    return sum_text(values, counts, angle, exercise, samples)


def sum_text(
    values: Numbers,
    counts: tuple[int, ...] | None,
    angle: bool,
    exercise: Exercise,
    samples: Samples,
) -> str:
    """``formula_text`` where the multiples of the joint variables are known, or are none (None)."""
    if counts is None:
        return ""
    moving = [joint.variable for joint in exercise.joints]
    motion = sum(n * samples.values[name] for n, name in zip(counts, moving, strict=True) if n)
    found = multiples((values - motion)[:HALF], angle, exercise, samples)
    if found is None:
        return ""
    shares, remainder = found
    terms = [*zip(counts, moving, strict=True), *shares]
    return _sum(_terms(terms, _constant(remainder, angle)))


def multiples(
    constant: Numbers, angle: bool, exercise: Exercise, samples: Samples
) -> tuple[list[tuple[int, str]], float] | None:
    """Whole multiples of letters and a remainder that add up to ``constant`` ``(HALF,)``.

    None if there are none. Letters with a share of 0 are left out.
    """
    first = constant[0]
    if np.abs(difference(constant, np.full_like(constant, first), angle)).max() < CONSTANT:
        return [], float(first)
    kind = "angle" if angle else "length"
    letters = [v.name for v in exercise.variables if v.joint is None and v.kind == kind]
    if not letters:
        return None
    basis, solver = samples.cached(("letters", kind), lambda: _basis(letters, samples))
    shares = np.round(constant @ solver)[:-1]
    rest = constant - shares @ basis[:-1]
    if np.ptp(rest) > WHOLE_MULTIPLE:
        return None
    found = zip(shares.astype(np.int_).tolist(), letters, strict=True)
    return [(share, letter) for share, letter in found if share], float(rest.mean())


def _basis(letters: list[str], samples: Samples) -> tuple[Numbers, Numbers]:
    """The letters' values and a constant, ``(letters + 1, HALF)``, and the pseudo-inverse."""
    basis = np.array([*(samples.values[name][:HALF] for name in letters), np.ones(HALF)])
    return basis, np.asarray(np.linalg.pinv(basis), dtype=np.float64)


def _constant(value: float, angle: bool) -> str:
    """A number as text, an angle as a fraction of pi or else in degrees; empty if it is 0."""
    if not angle:
        return "" if abs(value) < WHOLE_MULTIPLE else f"{value:.6g}"
    turned = float(difference(np.array(value), np.array(0.0), angle=True))
    if abs(turned) < WHOLE_MULTIPLE:
        return ""
    share = Fraction(turned / np.pi).limit_denominator(12)
    if abs(float(share) * np.pi - turned) > WHOLE_MULTIPLE:
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
