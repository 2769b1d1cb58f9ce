"""Find the formula that a student would write for given numbers."""

from fractions import Fraction

import numpy as np

from service.catalogue import Exercise
from service.expressions.printing.latex import to_latex
from service.expressions.printing.spelling import Spelling
from service.expressions.printing.text import to_text
from service.expressions.tree import Binary, Negation, Node, Number, Pi, SymbolNode, Unit
from service.grading.numerics.comparison import difference
from service.grading.numerics.joint_motion import coefficients
from service.grading.numerics.samples import HALF, Samples
from service.grading.numerics.tolerances import CONSTANT, PRINTED_NUMBER, WHOLE_MULTIPLE
from service.grading.report import Correction
from service.kinematics.transforms import Numbers

# A term of a sum and its sign.
_Term = tuple[int, Node]


def spelled(formula: Node, spelling: Spelling) -> Correction:
    """Return a correct formula as the student would write it."""
    return Correction(to_text(formula, spelling), to_latex(spelling.renamed(formula)))


def value_formula(
    values: Numbers, angle: bool, exercise: Exercise, samples: Samples, spelling: Spelling
) -> Correction | None:
    """Return ``values`` ``(SAMPLES,)`` as a formula such as ``theta2 + pi/2``, or None."""
    # The formula is a constant plus whole multiples of symbols, as in table cells. None if the
    # values are not such a sum.
    (counts,) = coefficients(values[None], exercise.joints, samples, np.array([angle]))
    return sum_formula(values, counts, angle, exercise, samples, spelling)


def sum_formula(
    values: Numbers,
    counts: tuple[int, ...] | None,
    angle: bool,
    exercise: Exercise,
    samples: Samples,
    spelling: Spelling,
) -> Correction | None:
    """Return ``values`` as a formula with joint variables, or None if there is no such formula.

    ``counts`` has the factor of each joint variable.
    """
    # None also if counts is None.
    if counts is None:
        return None
    moving = [joint.variable for joint in exercise.joints]
    motion = sum(n * samples.values[name] for n, name in zip(counts, moving, strict=True) if n)
    found = multiples((values - motion)[:HALF], angle, exercise, samples)
    if found is None:
        return None
    shares, remainder = found
    symbols = exercise.vocabulary.by_name
    terms = [
        _multiple(count, SymbolNode(symbols[name]))
        for count, name in (*zip(counts, moving, strict=True), *shares)
        if count
    ]
    constant = _angle(remainder, spelling) if angle else _length(remainder)
    return spelled(_sum([*terms, constant] if constant else terms), spelling)


def multiples(
    constant: Numbers, angle: bool, exercise: Exercise, samples: Samples
) -> tuple[list[tuple[int, str]], float] | None:
    """Split a constant into whole multiples of letters and a remaining number."""
    # constant is (HALF,). None if there is no such sum. Letters with the multiple 0 are left out.
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


def number_formula(values: Numbers, figures: int = 4) -> Correction | None:
    """Return ``values`` ``(SAMPLES,)`` as a plain number, or None if they vary."""
    if np.ptp(values) > PRINTED_NUMBER:
        return None
    value = float(values[0])
    node = _sum([] if abs(value) < PRINTED_NUMBER else [_number(value, figures)])
    return Correction(to_text(node), to_latex(node))


def _sum(terms: list[_Term]) -> Node:
    total: Node | None = None
    for sign, term in terms:
        if total is None:
            total = term if sign > 0 else _negated(term)
        else:
            total = Binary("+" if sign > 0 else "-", total, term)
    return Number(0.0, "0") if total is None else total


def _negated(term: Node) -> Node:
    # The minus sign is before the first factor: -2*l1, -3*pi/4.
    if isinstance(term, Binary):
        return Binary(term.operator, _negated(term.left), term.right)
    return Negation(term)


def _multiple(count: int, factor: Node) -> _Term:
    times = abs(count)
    product = factor if times == 1 else Binary("*", Number(float(times), str(times)), factor)
    return (1 if count > 0 else -1), product


def _number(value: float, figures: int) -> _Term:
    return (1 if value >= 0 else -1), Number(abs(value), f"{abs(value):.{figures}g}")


def _length(value: float) -> _Term | None:
    return None if abs(value) < WHOLE_MULTIPLE else _number(value, 6)


def _angle(value: float, spelling: Spelling) -> _Term | None:
    # In degrees or as a fraction of π. An angle that is not a multiple of π/12 is always in
    # degrees.
    turned = float(difference(np.array(value), np.array(0.0), angle=True))
    if abs(turned) < WHOLE_MULTIPLE:
        return None
    share = Fraction(turned / np.pi).limit_denominator(12)
    if share == -1:
        share, turned = Fraction(1), -turned
    if spelling.in_degrees or abs(float(share) * np.pi - turned) > WHOLE_MULTIPLE:
        sign, number = _number(float(np.degrees(turned)), 6)
        return sign, Unit(number, "deg")
    sign, turn = _multiple(share.numerator, Pi())
    below = share.denominator
    return sign, turn if below == 1 else Binary("/", turn, Number(float(below), str(below)))
