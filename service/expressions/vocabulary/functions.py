"""The functions and units that an expression may use, and their spellings."""

from typing import Final, Literal

ARITY: Final = {
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "sqrt": 1, "abs": 1,
    "exp": 1,
}  # fmt: skip
# The functions of degrees, as MATLAB has them: cosd(60) is cos(60deg), and acosd gives degrees.
OF_DEGREES: Final = {"sind": "sin", "cosd": "cos", "tand": "tan"}
IN_DEGREES: Final = {"asind": "asin", "acosd": "acos", "atand": "atan", "atan2d": "atan2"}
SPELLINGS: Final = {
    **{name: name for name in (*ARITY, *OF_DEGREES, *IN_DEGREES)},
    "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "tg": "tan",
    "arctg": "atan", "deg2rad": "deg", "rad2deg": "rad2deg",
}  # fmt: skip
# A function's name in capitals, and as Mathematica spells it.
CAPITALS: Final = {
    variant: name
    for spelling, name in SPELLINGS.items()
    for variant in (spelling.upper(), spelling.capitalize())
} | {"ArcSin": "asin", "ArcCos": "acos", "ArcTan": "atan", "ArcTan2": "atan2", "ATan2": "atan2"}
TRIGONOMETRIC: Final = frozenset({"sin", "cos", "tan"})
INVERSE: Final = frozenset({"asin", "acos", "atan", "atan2"})

UNITS: Final[dict[str, Literal["deg", "rad"]]] = {
    "deg": "deg", "degree": "deg", "degrees": "deg", "rad": "rad", "radian": "rad",
    "radians": "rad",
}  # fmt: skip
# ``degrees(x)`` and ``radians(x)`` mean opposite things to a reader and to Python, so only these
# two words may stand before a bracket.
UNIT_FUNCTIONS: Final = frozenset({"deg", "rad"})

PI: Final = ("pi", "π")
PI_CAPITALS: Final = ("Pi", "PI")
# Where functions live in Python: np.cos, math.pi.
MODULES: Final = frozenset({"np", "numpy", "math", "sp", "sympy", "sym", "jnp", "cmath", "mpmath"})
RESERVED: Final = frozenset({*SPELLINGS, *UNITS, *PI})
