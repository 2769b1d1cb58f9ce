"""The formula that a student would write for values of which only the numbers are known."""

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
    terms = [
        {1: name, -1: f"-{name}"}.get(count, f"{count}*{name}")
        for count, name in (*zip(counts, moving, strict=True), *shares)
        if count
    ]
    constant = _constant(remainder, angle)
    return " + ".join([*terms, constant] if constant else terms).replace(" + -", " - ") or "0"


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

    def basis_and_inverse() -> tuple[Numbers, Numbers]:
        basis = np.array([*(samples.values[name][:HALF] for name in letters), np.ones(HALF)])
        return basis, np.asarray(np.linalg.pinv(basis), dtype=np.float64)

    # The letters' values and a constant, ``(letters + 1, HALF)``.
    basis, solver = samples.cached(("letters", kind), basis_and_inverse)
    shares = np.round(constant @ solver)[:-1]
    rest = constant - shares @ basis[:-1]
    if np.ptp(rest) > WHOLE_MULTIPLE:
        return None
    found = zip(shares.astype(np.int_).tolist(), letters, strict=True)
    return [(share, letter) for share, letter in found if share], float(rest.mean())


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
