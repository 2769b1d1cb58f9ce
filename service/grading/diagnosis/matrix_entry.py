"""Slips in a single matrix entry.

Each function is one misconception that the student may have held. It returns what to say where the
formula without that misconception is right (or right but for its sign), else None. The first that
explains the entry is told.
"""

from collections.abc import Callable, Iterator, Mapping

from service.expressions.parsing.degrees import in_degrees
from service.expressions.printing.text import to_text
from service.expressions.tree import Node, Number, Unit, children
from service.grading.diagnosis.formula_repair import WrongEntry
from service.grading.diagnosis.formula_rewriting import (
    at_waves,
    everywhere,
    exchanged,
    first_term_negated,
    joints_multiplied,
    one_place,
    other_operator,
    products_merged,
    summed_from,
    sums_merged,
    without_degrees,
)
from service.grading.diagnosis.wrong_value import UNEXPLAINED, differs, undefined
from service.grading.feedback import Finding

# A planar arm of three joints has three runs of joints whose angles add up.
MAX_RUNS = 3
# How many nodes of unexplained formulas are taken apart before the rest of a matrix is only
# compared: where so much has another cause, the rest will have it too. What can be explained costs
# less of it, but not nothing: the work must be bounded.
WORK_BUDGET = 100.0
COST_IF_EXPLAINED = 0.25


def sign(case: WrongEntry) -> Finding | None:
    """The size is right, the direction is not."""
    if not case.equal(case.actual, -case.expected):
        return None
    return Finding("sign", "The sign of this entry is wrong.", case.correction)


def degrees_as_radians(case: WrongEntry) -> Finding | None:
    """A number in a sine or cosine was meant in degrees where radians are read."""
    if not any(_in_radians(wave) for wave in case.waves):
        return None
    repair = case.repaired_by([in_degrees(case.tree, is_angle=False, notes=[])])
    if repair is None:
        return None
    return Finding(
        "degrees_as_radians",
        "A number in a sine or cosine was read in radians, but it fits in degrees: write the unit "
        f"(90deg or 90°), or write it with pi.{repair.sign_too}",
        repair.correction,
    )


def _in_radians(wave: Node) -> bool:
    """Whether a number other than 0 stands in it without a unit."""
    if isinstance(wave, Unit):
        return False
    if isinstance(wave, Number):
        return wave.value != 0
    return any(map(_in_radians, children(wave)))


def radians_as_degrees(case: WrongEntry) -> Finding | None:
    """A number in a sine or cosine was meant in radians where degrees are read."""
    repair = case.repaired_by([everywhere(case.tree, without_degrees)])
    if repair is None:
        return None
    return Finding(
        "radians_as_degrees",
        "A number in a sine or cosine was read in degrees, but it fits in radians: write it with "
        f"pi, or in degrees.{repair.sign_too}",
        repair.correction,
    )


def sine_for_cosine(case: WrongEntry) -> Finding | None:
    """Sine was taken for cosine, or cosine for sine: throughout, or in one place."""
    if not case.waves:
        return None
    repair = case.repaired_by([at_waves(case.tree, exchanged)])
    if repair is not None:
        return Finding(
            "sine_for_cosine",
            f"Sine and cosine are exchanged in this entry.{repair.sign_too}",
            repair.correction,
        )
    if len(case.waves) == 1:
        return None
    repair = case.repaired_at(one_place(case.tree, exchanged))
    if repair is None or repair.place is None:
        return None
    return Finding(
        "sine_for_cosine",
        f"Sine and cosine are exchanged in one place of this entry.{repair.sign_too}",
        f"{to_text(repair.place)} should be {to_text(exchanged(repair.place))}.",
    )


def sum_of_cosines(case: WrongEntry) -> Finding | None:
    """The cosine of a sum was taken to be the sum of the cosines; the sine likewise."""
    if len(case.waves) < 2:
        return None
    repair = case.repaired_by([sums_merged(case.tree)])
    if repair is None:
        return None
    return Finding(
        "sum_of_cosines",
        "cos(a + b) is not cos(a) + cos(b), nor is sin(a + b) the sum of the sines: add up the "
        f"angles first.{repair.sign_too}",
        repair.correction,
    )


def product_for_sum_angle(case: WrongEntry) -> Finding | None:
    """The shorthand c12 was read as c1 c2, s12 as s1 s2, in all places or for some joints."""
    if len(case.waves) < 2:
        return None
    repair = case.repaired_by(_products_merged(case))
    if repair is None:
        return None
    return Finding(
        "product_for_sum_angle",
        "The shorthand c12 is the cosine of the sum, cos(θ1 + θ2), and not the product of two "
        f"cosines; s12 likewise.{repair.sign_too}",
        repair.correction,
    )


def _products_merged(case: WrongEntry) -> Iterator[Node]:
    runs = joints_multiplied(case.tree, sorted(case.turning))
    yield products_merged(case.tree)
    for joints in runs[:MAX_RUNS]:
        yield products_merged(case.tree, joints)


def relative_angle(case: WrongEntry) -> Finding | None:
    """A joint angle was taken to be measured from the base, though it counts from the link before.

    So c2 stands where the sum of the angles belongs, c12.
    """
    if not case.waves:
        return None
    repair = case.repaired_by(
        at_waves(case.tree, summed_from(first, case.turning)) for first in sorted(case.turning)[:-1]
    )
    if repair is None:
        return None
    return Finding(
        "relative_angle",
        "A joint angle counts from the link before, so the direction of a link further out takes "
        f"the sum of the angles up to it.{repair.sign_too}",
        repair.correction,
    )


def term_sign(case: WrongEntry) -> Finding | None:
    """One term of a sum has the wrong sign."""
    repair = case.repaired_at(_signs_changed(case.tree), negated_too=False)
    if repair is None:
        return None
    return Finding(
        "term_sign",
        "One term in this entry has the wrong sign.",
        repair.correction,
    )


def _signs_changed(tree: Node) -> Iterator[tuple[Node, Node]]:
    yield from one_place(tree, other_operator)
    yield from one_place(tree, first_term_negated)


MISCONCEPTIONS: tuple[Callable[[WrongEntry], Finding | None], ...] = (
    undefined,
    sign,
    degrees_as_radians,
    radians_as_degrees,
    sine_for_cosine,
    sum_of_cosines,
    product_for_sum_angle,
    relative_angle,
    term_sign,
)


def diagnose(case: WrongEntry, *, patient: bool = True) -> Finding:
    """What to say about a wrong entry: the first misconception that explains it.

    Without patience the formula is not taken apart.
    """
    for misconception in MISCONCEPTIONS if patient and case.can_be_repaired else (undefined, sign):
        finding = misconception(case)
        if finding is not None:
            return finding
    return differs(case, "This entry is not right; work it out again from the factors.")


def diagnose_entries(
    wrong: Mapping[tuple[int, int], WrongEntry], work_budget: float = WORK_BUDGET
) -> dict[tuple[int, int], Finding]:
    """The finding on each wrong entry; once ``work_budget`` is used up, formulas stay whole."""
    findings: dict[tuple[int, int], Finding] = {}
    for place, entry in wrong.items():
        findings[place] = diagnose(entry, patient=work_budget > 0)
        explained = findings[place].code != UNEXPLAINED
        work_budget -= entry.size * (COST_IF_EXPLAINED if explained else 1.0)
    return findings
