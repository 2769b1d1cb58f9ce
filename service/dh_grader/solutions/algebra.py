"""Formulas of a robot with SymPy, in the form that textbooks print.

SymPy never parses a text; nothing that grades imports this file.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from functools import reduce
from itertools import chain, product
from operator import add, mul, sub, truediv

import sympy

from dh_grader.catalogue import Exercise, FormulaGrid, Robot, ScrewRobot
from dh_grader.catalogue.robot import FormulaRow
from dh_grader.catalogue.schema_fields import FrameName
from dh_grader.expressions import Expression, ExpressionError, Symbol, Vocabulary, read
from dh_grader.expressions.printing import to_text
from dh_grader.expressions.vocabulary import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operator,
    Pi,
    SymbolNode,
    Unit,
)
from dh_grader.kinematics import Convention

# --- Multiply rigid motions (turns and shifts) in the form that textbooks print
#
# Vectors are 3×1, rotations 3×3 matrices of SymPy; angles are in radians.
#
# A general simplifier takes seconds for six joints, and its result does not look like a textbook's.
# Here the form results from the order of the steps:
# - Quarter turns about a coordinate axis are constant, and C Rot(u, φ) = Rot(C u, φ) C for a
#   constant rotation C. So these turns are moved to the right end; a 90° twist only changes later
#   axes.
# - Consecutive turns about the same axis, with only shifts between them, are combined: their angles
#   are added, which gives c12 and c123 without expanding and collecting sines and cosines.
# - Factors are applied from the right, and products of brackets are not expanded, which gives
#   c1 (c2 (c4 c5 c6 − s4 s6) − s2 s5 c6) − …, as books print the matrix of an arm with a wrist.


X = sympy.ImmutableMatrix([1, 0, 0])
Y = sympy.ImmutableMatrix([0, 1, 0])
Z = sympy.ImmutableMatrix([0, 0, 1])
ORIGIN = sympy.ImmutableMatrix([0, 0, 0])


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn about the unit vector ``axis`` through the origin."""

    axis: sympy.Matrix
    angle: sympy.Expr


@dataclass(frozen=True, slots=True)
class Shift:
    """A translation."""

    by: sympy.Matrix


@dataclass(frozen=True, slots=True)
class Fixed:
    """A rotation by a constant matrix."""

    rotation: sympy.Matrix


Motion = Turn | Shift | Fixed


@dataclass(frozen=True, slots=True)
class Pose:
    """The result of a product of motions: a rotation and a position."""

    rotation: sympy.Matrix
    position: sympy.Matrix

    def matrix(self) -> sympy.Matrix:
        """Return the homogeneous transform, 4×4."""
        upper = self.rotation.row_join(self.position)
        return upper.col_join(sympy.Matrix([[0, 0, 0, 1]]))


@dataclass(frozen=True, slots=True)
class Normal:
    """A product of motions, sorted so that its constant rotation comes last."""

    # The factors are the shift ``start``, the turns, each followed by a shift, and the rotation
    # ``end``.
    start: sympy.Matrix
    turns: tuple[tuple[Turn, sympy.Matrix], ...]
    end: sympy.Matrix


def inverse(motions: Sequence[Motion]) -> list[Motion]:
    """Return the inverse of the product of ``motions``."""
    return [_inverted(motion) for motion in reversed(motions)]


def _inverted(motion: Motion) -> Motion:
    match motion:
        case Turn(axis, angle):
            return Turn(axis, -angle)
        case Shift(by):
            return Shift(-by)
        case Fixed(rotation):
            return Fixed(rotation.T)


def multiplied(motions: Iterable[Motion]) -> Pose:
    """Return the product of ``motions`` from left to right."""
    normal = normalised(motions)
    rotation, position = normal.end, ORIGIN
    for run in reversed(_runs(normal.turns)):
        whole = rotation_about(run[-1][0].axis, run[-1][0].angle)
        rotation = whole * rotation
        position = whole * (run[-1][1] + position)
        for turn, shift in run[:-1]:
            position += rotation_about(turn.axis, turn.angle) * shift
    return Pose(rotation, normal.start + position)


def normalised(motions: Iterable[Motion]) -> Normal:
    """Return an equal product with quarter turns and fixed rotations moved to the right end."""
    constant = sympy.eye(3)
    shifts, turns = [ORIGIN], list[Turn]()
    for motion in motions:
        match motion:
            case Shift(by):
                shifts[-1] += constant * by
            case Fixed(rotation):
                constant *= rotation
            case Turn(axis, angle):
                rest, quarters = _split(axis, angle)
                if rest != 0:
                    turns.append(_upright(Turn(constant * axis, rest)))
                    shifts.append(ORIGIN)
                constant *= quarters
    return Normal(shifts[0], tuple(zip(turns, shifts[1:], strict=True)), constant)


def _split(axis: sympy.Matrix, angle: sympy.Expr) -> tuple[sympy.Expr, sympy.Matrix]:
    # The angle without its quarter turns, and the rotation by these quarter turns.
    constant, rest = angle.as_independent(*angle.free_symbols, as_Add=True)
    if axis not in (X, Y, Z) or not (2 * constant / sympy.pi).is_Integer:
        return angle, sympy.eye(3)
    return rest, rotation_about(axis, constant)


def _upright(turn: Turn) -> Turn:
    # An equal turn whose axis has no minus sign in its first nonzero number.
    first = next(number for number in turn.axis if number != 0)
    return Turn(-turn.axis, -turn.angle) if first.could_extract_minus_sign() else turn


def _runs(turns: Sequence[tuple[Turn, sympy.Matrix]]) -> list[list[tuple[Turn, sympy.Matrix]]]:
    # Group consecutive turns about the same axis; in a group, replace angles by running totals.
    runs: list[list[tuple[Turn, sympy.Matrix]]] = []
    for turn, shift in turns:
        if runs and runs[-1][-1][0].axis == turn.axis:
            so_far = runs[-1][-1][0].angle
            runs[-1].append((Turn(turn.axis, so_far + turn.angle), shift))
        else:
            runs.append([(turn, shift)])
    return runs


def rotation_about(axis: sympy.Matrix, angle: sympy.Expr) -> sympy.Matrix:
    """Return Rot(u, φ) = cos φ I + sin φ [u] + (1 − cos φ) u uᵀ.

    Source: Lynch and Park, *Modern Robotics*, eq. 3.51 (Rodrigues' formula).
    """
    x, y, z = axis
    skew = sympy.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    along = axis * axis.T
    cos, sin = folded(sympy.cos(angle)), folded(sympy.sin(angle))
    return cos * (sympy.eye(3) - along) + sin * skew + along


# --- Euler angles as formulas
#
# If the turns already have the requested sequence, their own angles are returned. Otherwise the
# angles are atan2 of matrix entries.
#
# The ZYZ angles of a spherical wrist are its joint angles.


Angles = tuple[sympy.Expr, sympy.Expr, sympy.Expr]

_AXES = {"X": X, "Y": Y, "Z": Z}
_QUARTERS = (0, sympy.pi / 2, sympy.pi, -sympy.pi / 2)


def euler_angles(motions: Iterable[Motion], sequence: str, axes: str) -> Angles:
    """Return the Euler angles, in a sequence such as "ZYZ", of the product of ``motions``.

    ``axes`` is "moving" or "fixed".
    """
    # Turns about fixed axes equal turns about moving axes in reverse order.
    steps = list(motions)
    if axes == "fixed":
        first, second, third = euler_angles(steps, sequence[::-1], "moving")
        return third, second, first
    direct = _own_angles(normalised(steps), sequence)
    return direct or _by_entries(multiplied(steps).rotation, sequence)


def _own_angles(normal: Normal, sequence: str) -> Angles | None:
    # None if the turns do not fit the sequence.
    angles = [sympy.S.Zero] * 3
    at = 0
    for turn, _ in normal.turns:
        while at < 3 and _AXES[sequence[at]] != turn.axis:
            at += 1
        if at == 3:
            return None
        angles[at] += turn.angle
    for quarters in product(*[(0,)] * at, *[_QUARTERS] * (3 - at)):
        rotation = sympy.eye(3)
        for letter, angle in zip(sequence, quarters, strict=True):
            rotation *= rotation_about(_AXES[letter], angle)
        if rotation == normal.end:
            first, second, third = (a + b for a, b in zip(angles, quarters, strict=True))
            return first, second, third
    return None


def _by_entries(rotation: sympy.Matrix, sequence: str) -> Angles:
    # The second angle is in [0, π] or in [−π/2, π/2]. Source: Spong, Hutchinson, Vidyasagar, *Robot
    # Modeling and Control*, §2.5.1 for ZYZ and §2.5.2 for ZYX. The other sequences follow by
    # renaming the axes, with a sign if the renamed frame is left-handed.
    i, j = map("XYZ".index, sequence[:2])
    k = 3 - i - j
    sign = 1 if (j - i) % 3 == 1 else -1
    R = rotation
    if sequence[0] == sequence[2]:
        return (
            sympy.atan2(R[j, i], -sign * R[k, i]),
            sympy.atan2(sympy.sqrt(R[i, j] ** 2 + R[i, k] ** 2), R[i, i]),
            sympy.atan2(R[i, j], sign * R[i, k]),
        )
    return (
        sympy.atan2(-sign * R[j, k], R[k, k]),
        sympy.atan2(sign * R[i, k], sympy.sqrt(R[i, i] ** 2 + R[i, j] ** 2)),
        sympy.atan2(-sign * R[i, j], R[i, i]),
    )


def as_angle(sine: sympy.Expr, cosine: sympy.Expr) -> sympy.Expr:
    """Return the angle with this sine and cosine: φ for sin φ and cos φ, else an atan2."""
    found = sine.atoms(sympy.sin, sympy.cos) | cosine.atoms(sympy.sin, sympy.cos)
    arguments = sorted((call.args[0] for call in found), key=str)
    for argument, quarter, sign in product((sympy.S.Zero, *arguments), _QUARTERS, (1, -1)):
        angle = quarter + sign * argument
        if sympy.sin(angle) == sine and sympy.cos(angle) == cosine:
            return angle
    return sympy.atan2(sine, cosine)


# --- Evaluate constants without a closed form, such as cos 0.3, to one number
#
# The numbers have more digits than are printed, so that terms cancel to exactly 0.
#
# A robot given in numbers has such a constant in each twist. Products of six of them would fill a
# page.


# The number of digits that are printed, and that are computed.
_DIGITS = 15
_WORKING_DIGITS = 40
# Smaller numbers are rounding errors of a difference that is 0.
_NOTHING = sympy.Float("1e-25", _WORKING_DIGITS)
# More decimals are not printed.
DECIMALS = 20
_LAST_DECIMAL = Decimal(1).scaleb(-DECIMALS)
_EXACT = Context(prec=400)
_ROUNDED = Context(prec=_DIGITS, rounding=ROUND_HALF_EVEN)


def folded(expression: sympy.Expr) -> sympy.Expr:
    """Evaluate a constant with a sine or cosine; return any other expression unchanged."""
    has_none = expression.is_number and expression.has(sympy.sin, sympy.cos)
    return expression.evalf(_WORKING_DIGITS) if has_none else expression


def is_unwieldy(expression: sympy.Expr) -> bool:
    """True if a number has no closed form, or more decimals than are printed."""
    return expression.has(sympy.Float) or any(
        number.q > 10**DECIMALS for number in expression.atoms(sympy.Rational)
    )


def rounded(expression: sympy.Expr) -> sympy.Expr:
    """Return the expression with its constants rounded to 15 digits, except in angles."""
    values = _evaluated(expression)
    return values.xreplace({each: _rational(each) for each in values.atoms(sympy.Float)})


def _evaluated(expression: sympy.Expr) -> sympy.Expr:
    if expression.is_number:
        return expression.evalf(_WORKING_DIGITS)
    if isinstance(expression, sympy.Add | sympy.Mul):
        return expression.func(*map(_evaluated, expression.args))
    if isinstance(expression, sympy.Pow):
        return _evaluated(expression.base) ** expression.exp
    return expression


def _rational(number: sympy.Float) -> sympy.Rational:
    if abs(number) < _NOTHING:
        return sympy.S.Zero
    digits = _ROUNDED.create_decimal(str(number))
    return sympy.Rational(str(digits.quantize(_LAST_DECIMAL, context=_EXACT)))


# SymPy never parses a text.


FUNCTIONS: Mapping[str, sympy.Function] = {
    "sin": sympy.sin,
    "cos": sympy.cos,
    "tan": sympy.tan,
    "asin": sympy.asin,
    "acos": sympy.acos,
    "atan": sympy.atan,
    "atan2": sympy.atan2,
    "sqrt": sympy.sqrt,
    "abs": sympy.Abs,
    "exp": sympy.exp,
}


_OPERATORS: Mapping[Operator, Callable[[sympy.Expr, sympy.Expr], sympy.Expr]] = {
    "+": add,
    "-": sub,
    "*": mul,
    "/": truediv,
    "^": pow,
}


class Algebra:
    """Converts one exercise's formulas to SymPy; symbols with a positive range are positive.

    With ``home``, all joint variables are 0.
    """

    def __init__(self, exercise: Exercise, *, home: bool = False) -> None:
        self.symbols: dict[str, sympy.Expr] = {
            variable.name: sympy.Symbol(variable.name, positive=True)
            if variable.low > 0
            else sympy.Symbol(variable.name, real=True)
            for variable in exercise.variables
        }
        if home:
            self.symbols |= {joint.variable: sympy.S.Zero for joint in exercise.joints}

    def of(self, formula: Expression) -> sympy.Expr:
        """Return the formula in SymPy; numbers stay exact."""
        return self._node(formula.tree)

    def matrix(self, grid: FormulaGrid) -> sympy.Matrix:
        """Return a grid of formulas as a matrix."""
        return sympy.Matrix([[self.of(formula) for formula in row] for row in grid])

    def _node(self, node: Node) -> sympy.Expr:
        match node:
            case Number(literal=literal):
                exact = Fraction(Decimal(literal))
                return sympy.Rational(exact.numerator, exact.denominator)
            case Pi():
                return sympy.pi
            case SymbolNode(symbol):
                return self.symbols[symbol.name]
            case Unit(operand, unit):
                return self._node(operand) * (sympy.pi / 180 if unit == "deg" else 1)
            case Negation(operand):
                return -self._node(operand)
            case Call(function, arguments):
                return FUNCTIONS[function](*map(self._node, arguments))
            case Binary(operator, left, right):
                return _OPERATORS[operator](self._node(left), self._node(right))


# --- Convert SymPy expressions to syntax trees, in a textbook's order and shorthand
#
# A shorthand such as c12 is used only if a reader gives it the same meaning.
#
# ``dh_grader.expressions`` prints these trees. A shorthand is a symbol in the tree; it is used only
# if the reader of entries would read c12 with the same meaning.


_NAMES = {function: name for name, function in FUNCTIONS.items()}
_TRIGONOMETRIC = (sympy.sin, sympy.cos, sympy.tan)
# Fractions with these denominators stay fractions; others become finite decimals if possible.
_PLAIN_DENOMINATORS = (1, 2, 3, 4)

# A formula with more nodes would be longer than an answer may be.
_MOST_NODES = 1000

# The sort key of a factor in a product: rank, joints, True for a sine, text.
FactorOrder = tuple[int, list[int], bool, str]


class TooLongError(Exception):
    """The formula is longer than an answer may be."""


class Writer:
    """Converts one exercise's SymPy expressions to syntax trees.

    ``used`` maps each shorthand used so far to its meaning.
    """

    def __init__(self, exercise: Exercise) -> None:
        self.used: dict[str, str] = {}
        self._vocabulary = exercise.vocabulary
        self._symbols = {symbol.name: symbol for symbol in exercise.vocabulary.symbols}
        ordered = sorted(exercise.variables, key=lambda variable: variable.joint or 0)
        self._order = {variable.name: i for i, variable in enumerate(ordered)}

    def number(self, expression: sympy.Expr) -> Node:
        """Return the tree of a number or a length. May raise TooLongError."""
        if is_unwieldy(expression):
            expression = rounded(expression)
        if _size(expression, {}) > _MOST_NODES:
            raise TooLongError
        return self._node(_without_negative_brackets(expression))

    def _node(self, expression: sympy.Expr) -> Node:
        if isinstance(expression, sympy.Add):
            return _signed_sum(sorted(expression.args, key=self._term_order), self._node)
        if isinstance(expression, sympy.Symbol):
            return SymbolNode(self._symbols[expression.name])
        if isinstance(expression, sympy.Pow):
            return self._power(*expression.args)
        if expression == sympy.pi:
            return Pi()
        if isinstance(expression, sympy.Mul | sympy.Rational):
            return self._product(expression)
        return self._call(expression)

    def angle(self, expression: sympy.Expr) -> Node:
        """Return the tree of an angle."""
        # A plain number gets the unit rad, so that it means the same to a student who works in
        # degrees.

        def term(value: sympy.Expr) -> Node:
            node = self._node(value)
            return Unit(node, "rad") if value.is_Rational and value != 0 else node

        terms = sympy.Add.make_args(expression)
        ordered = sorted(
            terms, key=lambda each: (_negative(each), each.is_number, *self._term_order(each))
        )
        return _signed_sum(ordered, term)

    def _product(self, expression: sympy.Expr) -> Node:
        factor, rest = expression.as_coeff_Mul()
        if factor < 0:
            return _negated(self._node(-expression))
        whole = factor.q in _PLAIN_DENOMINATORS or _decimal(factor) is None
        above, below = (
            ([sympy.Integer(factor.p)], [sympy.Integer(factor.q)]) if whole else ([factor], [])
        )
        for each in sympy.Mul.make_args(rest):
            divides = isinstance(each, sympy.Pow) and _negative(each.exp)
            (below if divides else above).append(1 / each if divides else each)
        upper = self._chain([each for each in above if each != 1])
        lower = [each for each in below if each != 1]
        return Binary("/", upper, self._chain(lower)) if lower else upper

    def _chain(self, factors: Sequence[sympy.Expr]) -> Node:
        # The factors are not fractions.
        nodes = [
            _number(each) if isinstance(each, sympy.Rational) else self._node(each)
            for each in sorted(factors, key=self._factor_order)
        ]
        return reduce(lambda left, right: Binary("*", left, right), nodes or [_number(sympy.S.One)])

    def _power(self, base: sympy.Expr, exponent: sympy.Expr) -> Node:
        if _negative(exponent):
            return Binary("/", _number(sympy.S.One), self._node(base**-exponent))
        if exponent == sympy.Rational(1, 2):
            return Call("sqrt", (self._node(base),))
        return Binary("^", self._node(base), self._node(exponent))

    def _call(self, expression: sympy.Expr) -> Node:
        name = _NAMES[expression.func]
        if not isinstance(expression, _TRIGONOMETRIC):
            return Call(name, tuple(map(self._node, expression.args)))
        call = Call(name, (self.angle(expression.args[0]),))
        short = self._shorthand(name, sympy.Add.make_args(expression.args[0]))
        if short is None or not _reads_as(short, call, self._vocabulary):
            return call
        self.used[short] = to_text(call)
        return SymbolNode(Symbol(short, "number"))

    def _shorthand(self, function: str, terms: Sequence[sympy.Expr]) -> str | None:
        # The shorthand for a function of a sum of joint angles, such as c12.
        symbols = [self._symbols.get(str(term)) for term in terms]
        joints = [symbol.joint for symbol in symbols if symbol and symbol.joint is not None]
        if function == "tan" or len(joints) < len(terms):
            return None
        return function[0] + "".join(map(str, sorted(joints)))

    def _term_order(self, term: sympy.Expr) -> tuple[bool, list[FactorOrder], list[int], str]:
        # Plus before minus, then lengths before sines, then joints.
        factors = sorted(map(self._factor_order, sympy.Mul.make_args(term)))
        joints = sorted(self._order[symbol.name] for symbol in term.free_symbols)
        return _negative(term), [each for each in factors if each[0] > 1], joints, str(term)

    def _factor_order(self, factor: sympy.Expr) -> FactorOrder:
        # Numbers, symbols, sines and cosines (by joints), brackets.
        base = factor.base if isinstance(factor, sympy.Pow) else factor
        is_symbol, is_turn = isinstance(base, sympy.Symbol), isinstance(base, _TRIGONOMETRIC)
        rank = (bool(base.is_number), is_symbol, is_turn, True).index(True)
        orders = sorted(self._order[symbol.name] for symbol in base.free_symbols)
        return rank, orders, isinstance(base, sympy.sin), str(base)


def _signed_sum(terms: Sequence[sympy.Expr], write: Callable[[sympy.Expr], Node]) -> Node:
    signed = [(_negative(term), write(-term if _negative(term) else term)) for term in terms]
    negative, first = signed[0]
    result = _negated(first) if negative else first
    for negative, node in signed[1:]:
        result = Binary("-" if negative else "+", result, node)
    return result


def _negative(term: sympy.Expr) -> bool:
    return bool(term.as_coeff_Mul()[0] < 0)


def _size(expression: sympy.Expr, known: dict[sympy.Expr, int]) -> int:
    # ``known`` memoizes subexpressions.
    if expression not in known:
        known[expression] = 1 + sum(_size(part, known) for part in expression.args)
    return known[expression]


def _negated(node: Node) -> Node:
    # A minus before the first factor: −c1 s2, not −(c1 s2).
    if isinstance(node, Binary) and node.operator in ("*", "/"):
        return Binary(node.operator, _negated(node.left), node.right)
    return Negation(node)


def _without_negative_brackets(expression: sympy.Expr) -> sympy.Expr:
    # −s2 (a + b) for s2 (−a − b).
    def turned(product: sympy.Expr) -> sympy.Expr:
        factors = [
            -each if isinstance(each, sympy.Add) and all(map(_negative, each.args)) else each
            for each in product.args
        ]
        changed = sum(a is not b for a, b in zip(factors, product.args, strict=True))
        return sympy.Mul(*factors, sympy.S.NegativeOne**changed)

    return expression.replace(lambda each: isinstance(each, sympy.Mul), turned)


def _number(value: sympy.Rational) -> Node:
    # A whole number or a finite decimal, which must not be negative.
    literal = str(value.p) if value.q == 1 else _decimal(value)
    assert literal is not None
    return Number(float(literal), literal)


def _decimal(value: sympy.Rational) -> str | None:
    exact = Fraction(int(value.p), int(value.q))
    for digits in range(DECIMALS + 1):
        scaled = exact * 10**digits
        if scaled.denominator == 1:
            return f"{Decimal(scaled.numerator).scaleb(-digits):f}"
    return None


def _reads_as(text: str, tree: Node, vocabulary: Vocabulary) -> bool:
    try:
        return read(text, vocabulary).tree == tree
    except ExpressionError:
        return False


# --- The reference robot as a product of motions


def link(row: FormulaRow, convention: Convention, algebra: Algebra) -> list[Motion]:
    """Return the motions of one row of a DH table."""
    a, alpha, d, theta = map(algebra.of, row)
    along_z: list[Motion] = [Turn(Z, theta), Shift(d * Z)]
    along_x: list[Motion] = [Shift(a * X), Turn(X, alpha)]
    return along_z + along_x if convention is Convention.STANDARD else along_x + along_z


def between(
    exercise: Exercise, start: FrameName, end: FrameName, algebra: Algebra, *, home: bool = False
) -> list[Motion]:
    """Return the motions from one frame of the robot to another.

    With ``home``, all joint variables are 0. Raises LookupError if the exercise has no robot.
    """
    # Frames are "base", "tool" and the frame numbers of the robot's own table.
    motions = _steps(exercise, Algebra(exercise, home=True) if home else algebra)
    first, last = (_place(exercise, frame, len(motions)) for frame in (start, end))
    steps = list(chain.from_iterable(motions[min(first, last) : max(first, last)]))
    return steps if first <= last else inverse(steps)


def _steps(exercise: Exercise, algebra: Algebra) -> list[list[Motion]]:
    match exercise.reference:
        case Robot(tables=tables, convention=convention):
            return [link(row, convention, algebra) for row in tables[convention].rows]
        case ScrewRobot() as robot:
            return [_exponentials(robot, algebra)]
        case _:
            raise LookupError(f"exercise {exercise.id!r} has no robot")


def _place(exercise: Exercise, frame: FrameName, steps: int) -> int:
    if isinstance(frame, str):
        return {"base": 0, "tool": steps}[frame]
    return frame - exercise.joints[0].index + 1


def _exponentials(robot: ScrewRobot, algebra: Algebra) -> list[Motion]:
    # Single turns and shifts whose product is e^{[S_1]θ_1} … e^{[S_n]θ_n} M. A turn about a screw
    # axis is written about the point of the axis nearest to the origin.
    motions: list[Motion] = []
    for joint, axis in zip(robot.joints, algebra.matrix(robot.axes).tolist(), strict=True):
        amount = algebra.symbols[joint.variable]
        omega, v = sympy.Matrix(axis[:3]), sympy.Matrix(axis[3:])
        if omega.is_zero_matrix:
            motions.append(Shift(amount * v))
            continue
        point, pitch = omega.cross(v), omega.dot(v)
        turn = Turn(omega.as_immutable(), amount)
        motions += [Shift(point), turn, Shift(pitch * amount * omega - point)]
    home = algebra.matrix(robot.home)
    return [*motions, Shift(home[:3, 3]), Fixed(home[:3, :3])]


def joint_axes(exercise: Exercise) -> list[tuple[sympy.Matrix, sympy.Matrix]]:
    """Return a direction and a point of each joint axis, with all joint variables 0.

    Both are 3×1 in the base frame. Raises LookupError if the robot has no table.
    """
    robot, algebra = exercise.robot, Algebra(exercise, home=True)
    # The joint axis is z before the motions of a standard row, but after a and α of a modified one.
    at = 0 if robot.convention is Convention.STANDARD else 2
    rotation, position = sympy.eye(3), sympy.zeros(3, 1)
    axes = []
    for row, _ in zip(robot.tables[robot.convention].rows, robot.joints, strict=False):
        for i, motion in enumerate(link(row, robot.convention, algebra)):
            if i == at:
                axes.append((rotation * Z, position))
            step = multiplied([motion])
            position += rotation * step.position
            rotation *= step.rotation
    return axes
