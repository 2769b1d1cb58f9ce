"""The functions and units that an expression may use, and their spellings."""

from typing import Final, Literal

PieceKind = Literal[
    "symbol", "pi", "constant", "function", "number", "unit", "shorthand", "invalid_shorthand"
]

ARITY: Final = {
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "sqrt": 1, "abs": 1,
    "exp": 1,
}  # fmt: skip
# MATLAB's functions of degrees: cosd(60) is cos(60deg), and acosd returns degrees.
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
# For a human reader and in Python, ``degrees(x)`` and ``radians(x)`` have opposite meanings, so
# only these two words may precede a bracket.
UNIT_FUNCTIONS: Final = frozenset({"deg", "rad"})

PI: Final = ("pi", "π")
PI_CAPITALS: Final = ("Pi", "PI")
# Modules that programs write before a function: np.cos, math.pi, Math.PI, std::cos.
MODULES: Final = frozenset({
    "np", "numpy", "math", "sp", "sympy", "sym", "jnp", "cmath", "mpmath", "mp", "scipy", "Math",
    "MathF", "std", "numbers", "torch", "tf", "casadi", "ca", "symengine",
})  # fmt: skip

# Functions that are built from other functions (see ``parsing/built``), with their number of
# arguments; 0 for any number.
BUILT: Final = {
    "sec": 1, "csc": 1, "cot": 1, "pow": 2, "hypot": 2, "quotient": 2, "sum": 0, "product": 0,
    "value": 1,
}  # fmt: skip
# Constants of C: a root, or π over a number.
CONSTANTS: Final = {
    "M_PI_2": ("pi", 2), "M_PI_4": ("pi", 4), "M_SQRT2": ("sqrt", 2), "M_SQRT1_2": ("1/sqrt", 2),
}  # fmt: skip
# Words that are read only as a whole run, not as part of a longer one: cosf1 is cos(f1).
ALONE: Final[dict[str, tuple[PieceKind, str]]] = {
    **{
        spelling: ("function", name)
        for name, spellings in {
            "sec": ("sec", "Sec", "SEC"), "csc": ("csc", "Csc", "CSC", "cosec"),
            "cot": ("cot", "Cot", "COT", "cotan", "ctg", "cotg"),
            "sin": ("sen", "sinf", "SEN"), "cos": ("cosf",), "tan": ("tanf",),
            "asin": ("arcsen", "asen", "asinf"), "acos": ("acosf",), "atan": ("atanf",),
            "atan2": ("atan2f",), "sqrt": ("sqrtf",), "abs": ("fabs", "fabsf"),
            "pow": ("pow", "powf", "Power", "Pow", "POWER", "power"), "hypot": ("hypot",),
            "quotient": ("Rational", "Divide"), "sum": ("Plus", "Add"),
            "product": ("Times", "Mul"),
            "value": ("sym", "vpa", "simplify", "Simplify", "expand", "Expand", "float", "double"),
        }.items()
        for spelling in spellings
    },
    # In spreadsheets, these make radians of a number of degrees.
    **dict.fromkeys(("RADIANS", "BOGENMASS", "RADIANES", "RADIANTI"), ("function", "deg")),
    **dict.fromkeys(("Grad", "grados", "gradi", "graus", "degre", "degres"), ("unit", "deg")),
    **{name: ("constant", name) for name in CONSTANTS},
    "M_PI": ("pi", "pi"), "kPi": ("pi", "pi"), "Degree": ("unit", "deg"),
}  # fmt: skip
# Functions that no answer needs. They are refused by name, so that they are not read as products.
REFUSED: Final = frozenset({
    "log", "ln", "lg", "log10", "log2", "log1p", "expm1", "Log", "LN", "LOG",
    "sinh", "cosh", "tanh", "coth", "sech", "csch", "Sinh", "Cosh", "Tanh",
    *(f"{a}{name}" for a in ("a", "ar", "arc") for name in ("sinh", "cosh", "tanh", "coth")),
    *(f"{a}{name}" for a in ("a", "arc") for name in ("sec", "csc", "cot", "ctg", "cotg")),
    "max", "min", "Max", "Min", "MAX", "MIN", "floor", "Floor", "ceil", "ceiling", "round", "trunc",
    "fix", "sign", "Sign", "sgn", "SIGN", "signum", "mod", "Mod", "MOD", "rem", "fmod", "wrapToPi",
    "factorial", "diff", "int", "sum", "dot", "cross", "norm", "det", "gcd",
    "sinc", "cis", "versin", "haversin", "erf", "heaviside", "piecewise", "Piecewise", "unwrap",
})  # fmt: skip
RESERVED: Final = frozenset({*SPELLINGS, *UNITS, *PI})
