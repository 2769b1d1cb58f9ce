"""Slips in a single matrix entry."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from service.expressions import Symbol
from service.expressions.parsing.degrees import in_degrees
from service.expressions.tree import Node, Number, Unit, children
from service.grading.diagnosis.formulas import formula_rewriting as rewriting
from service.grading.diagnosis.formulas.formula_repair import Rewritten, WrongEntry
from service.grading.diagnosis.upstream.missing_symbol import (
    Dependence,
    Required,
    Requirements,
)
from service.grading.diagnosis.wrong_value import finding_on
from service.grading.feedback import Finding
from service.grading.misconception import Written, diagnosed, misconception, says
from service.kinematics.transforms import Numbers
from service.translations import say

# Three turning joints have three runs of joints whose angles add up: 12, 23, 123.
MAX_RUNS = 3
# Up to this many sines and cosines, a joint angle is also tried in one place alone.
MAX_PLACES = 3
# The number of nodes that are rewritten before the rest of a matrix is only compared: after many
# unexplained entries, the rest probably has the same unknown cause. An explained entry costs less,
# but not nothing, because the work must be bounded.
WORK_BUDGET = 100.0
COST_IF_EXPLAINED = 0.25
# The work of an entry, and of each node of a rewritten formula, as the budget counts it.
ENTRY_WORK, NODE_WORK = 1.0, 0.2

Formulas = Iterator[Rewritten]


@misconception(
    of=WrongEntry,
    rank=100,
    code="sign",
    rule="sine_and_cosine",
    means="the whole entry has the wrong sign",
    example=("planar-rr", "pose", {"1/2": "s12"}),
    unlike={"1/2": "c12"},
)
def sign(case: WrongEntry) -> Iterator[Written[Numbers]]:
    """The entry has the wrong sign."""
    yield Written(-case.expected, finding_on(case, say("The sign is wrong.")))


@misconception(
    of=WrongEntry,
    rank=110,
    code="degrees_as_radians",
    rule="angle_unit",
    when=lambda case: case.can_be_repaired,
    means="a number of degrees in a sine or cosine is read in radians",
    example=("planar-rr", "pose", {"1/2": "cos(q1 + q2 + 90)"}),
    unlike={"1/2": "s12"},
)
def degrees_as_radians(case: WrongEntry) -> Formulas:
    """A number in a sine or cosine was meant in degrees, but is read in radians."""
    finding = says(
        say(
            "A number in a sine or cosine was read in radians, but it fits in degrees: write the "
            "unit behind it (deg or °)."
        ),
    )
    if any(map(_has_bare_number, case.sines_and_cosines)):
        yield Rewritten(in_degrees(case.tree, is_angle=False, notes=[]), finding)


def _has_bare_number(node: Node) -> bool:
    if isinstance(node, Number):
        return node.value != 0
    return not isinstance(node, Unit) and any(map(_has_bare_number, children(node)))


@misconception(
    of=WrongEntry,
    rank=120,
    code="radians_as_degrees",
    rule="angle_unit",
    when=lambda case: case.can_be_repaired,
    means="a number of radians in a sine or cosine is read in degrees",
    example=(
        "planar-rr",
        "pose",
        (
            "[cos(q1 + q2), cos(q1 + q2 + 1.5708), 0, a1 c1 + a2 c12; s12, c12, 0, a1 s1 + a2 s12; "
            "0, 0, 1, 0; 0, 0, 0, 1]"
        ),
        "degrees",
    ),
    unlike={"4/3": "1"},
)
def radians_as_degrees(case: WrongEntry) -> Formulas:
    """A number in a sine or cosine was meant in radians, but is read in degrees."""
    finding = says(
        say(
            "A number in a sine or cosine was read in degrees, but it fits in radians: write the "
            "unit behind it (rad)."
        ),
    )
    yield Rewritten(rewriting.everywhere(case.tree, rewriting.without_degrees), finding)


@misconception(
    of=WrongEntry,
    rank=130,
    code="sine_for_cosine",
    rule="sine_and_cosine",
    when=lambda case: case.can_be_repaired,
    means="sine and cosine are exchanged, throughout or in one place",
    example=("planar-rr", "pose", {"1/4": "a1 s1 + a2 s12"}),
    unlike={"1/2": "s12"},
)
def sine_for_cosine(case: WrongEntry) -> Formulas:
    """Some or all sines and cosines are exchanged."""
    count = len(case.sines_and_cosines)
    if count > 0:
        finding = says(say("Sine and cosine are exchanged."))
        yield Rewritten(rewriting.at_sines_and_cosines(case.tree, rewriting.exchanged), finding)
    if count > 1:
        in_one_place = says(say("Sine and cosine are exchanged in one place."))
        for tree, _ in rewriting.one_place(case.tree, rewriting.exchanged):
            yield Rewritten(tree, in_one_place)


@misconception(
    of=WrongEntry,
    rank=140,
    code="sum_of_cosines",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="cos(a + b) is written as cos a + cos b, or the same with the sine",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + a2 (c1 + c2)"}),
    unlike={"1/2": "s12"},
)
def sum_of_cosines(case: WrongEntry) -> Formulas:
    """The student wrote cos(a + b) as cos a + cos b, or sin(a + b) as sin a + sin b."""
    finding = says(
        say(
            "cos(a + b) is not cos(a) + cos(b), and sin(a + b) is not sin(a) + sin(b): add the "
            "angles first."
        ),
    )
    if len(case.sines_and_cosines) > 1:
        yield Rewritten(rewriting.sums_merged(case.tree), finding)


@misconception(
    of=WrongEntry,
    rank=150,
    code="product_for_sum_angle",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="c12 is written as c1 c2, or s12 as s1 s2",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + a2 c1 c2"}),
    unlike={"1/2": "s12"},
)
def product_for_sum_angle(case: WrongEntry) -> Formulas:
    """The student read the shorthand c12 as c1 c2, or s12 as s1 s2."""
    finding = says(
        say(
            "Check this product of sines or cosines: the direction of a link has one sine or "
            "cosine of a sum of joint angles."
        ),
    )
    if len(case.sines_and_cosines) > 1:
        yield Rewritten(rewriting.products_merged(case.tree), finding)
        for joints in rewriting.joints_multiplied(case.tree, sorted(case.turning))[:MAX_RUNS]:
            yield Rewritten(rewriting.products_merged(case.tree, joints), finding)


@misconception(
    of=WrongEntry,
    rank=160,
    code="relative_angle",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="a joint's own angle is used for the sum of the angles up to it: c2 for c12",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + a2 c2"}),
    unlike={"1/2": "s12"},
)
def relative_angle(case: WrongEntry) -> Formulas:
    """The student wrote the joint's own angle instead of a sum of angles: c2 for c12."""
    finding = says(
        say(
            "A joint angle is measured from the link before: the direction of a link is the sum "
            "of all joint angles up to it."
        ),
    )
    for first in sorted(case.turning)[:-1] if case.sines_and_cosines else ():
        summed = rewriting.summed_from(first, case.turning)
        yield Rewritten(rewriting.at_sines_and_cosines(case.tree, summed), finding)


@misconception(
    of=WrongEntry,
    rank=180,
    code="joint_variable_missing",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="a joint angle is missing in the sum in a sine or cosine",
    example=("planar-rr", "pose", {"1/2": "-s1"}),
    unlike={"1/2": "s12"},
)
def angle_left_out(case: WrongEntry) -> Formulas:
    """A joint angle is missing in a sum of joint angles: c23 for c123."""
    for symbol in _joint_angles(case):
        finding = says(
            say(
                "{angle} is missing in a sine or cosine: the direction of a link is the sum of all "
                "joint angles up to it.",
                angle=case.spelling.name(symbol),
            ),
        )
        yield from _with_angles_changed(case, rewriting.with_angle(symbol), finding)


@misconception(
    of=WrongEntry,
    rank=190,
    code="joint_variable_extra",
    rule="angle_sum",
    when=lambda case: case.can_be_repaired,
    means="the entry contains a joint variable too many, alone or in a sum of joint angles",
    example=("planar-rr", "pose", {"1/4": "a1 c12 + a2 c12"}),
    unlike={"1/2": "s12"},
)
def angle_too_many(case: WrongEntry) -> Formulas:
    """A sum of joint angles contains one angle too many: c123 for c12."""
    for symbol in _joint_angles(case):
        finding = says(
            say(
                "{angle} does not belong in a sine or cosine here: check which joint angles add up "
                "to this direction.",
                angle=case.spelling.name(symbol),
            ),
        )
        yield from _with_angles_changed(case, rewriting.without_angle(symbol), finding)


def _joint_angles(case: WrongEntry) -> list[Symbol]:
    return [case.turning[k] for k in sorted(case.turning)] if case.sines_and_cosines else []


def _with_angles_changed(
    case: WrongEntry, change: rewriting.Rewriting, finding: Finding
) -> Formulas:
    # If the formula is short, each single sine or cosine is also changed alone.
    yield Rewritten(rewriting.at_sines_and_cosines(case.tree, change), finding, signed=True)
    if 1 < len(case.sines_and_cosines) <= MAX_PLACES:
        for tree, _ in rewriting.one_place(case.tree, change):
            yield Rewritten(tree, finding, signed=True)


@misconception(
    of=WrongEntry,
    rank=170,
    code="term_sign",
    rule="sine_and_cosine",
    when=lambda case: case.can_be_repaired,
    means="one term has the wrong sign",
    example=("planar-rr", "pose", {"1/4": "a1 c1 - a2 c12"}),
    unlike={"1/4": "a1 c1 + 2 a2 c12"},
)
def term_sign(case: WrongEntry) -> Formulas:
    """One term of a sum has the wrong sign."""
    finding = says(say("One term has the wrong sign."))
    for change in (rewriting.other_operator, rewriting.first_term_negated):
        for tree, _ in rewriting.one_place(case.tree, change):
            yield Rewritten(tree, finding, signed=True)


def diagnose(case: WrongEntry, required: Required | None = None) -> Finding:
    """Return the finding on a wrong entry.

    ``required`` are the symbols that the correct entry depends on, or None if they are unknown.
    """
    return diagnosed(case) or _unexplained(case, required)


def diagnose_entries(
    wrong: Mapping[tuple[int, int], WrongEntry],
    affords: Callable[[float], bool],
    work_budget: float = WORK_BUDGET,
    requirements: Requirements | None = None,
) -> dict[tuple[int, int], Finding]:
    """Return the findings on the wrong entries of a matrix."""
    # affords takes work from the budget of the submission; work_budget is the budget of the matrix.
    # When it is used up, formulas are no longer rewritten.
    findings: dict[tuple[int, int], Finding] = {}
    for place, entry in wrong.items():
        if not affords(ENTRY_WORK + (NODE_WORK * entry.size if work_budget > 0 else 0.0)):
            continue
        explained = diagnosed(entry if work_budget > 0 else replace(entry, only_compared=True))
        work_budget -= entry.size * (COST_IF_EXPLAINED if explained else 1.0)
        required = requirements.of(*place) if requirements and not explained else None
        findings[place] = explained or _unexplained(entry, required)
    return findings


def _unexplained(case: WrongEntry, required: Required | None) -> Finding:
    finding = diagnosed(case, Dependence(case, required))
    assert finding is not None
    return finding
