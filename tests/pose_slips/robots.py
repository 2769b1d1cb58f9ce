"""The robots for tests of slips in tables."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp
from dh_grader.catalogue import shipped_folder

PARTS = """
[[parts]]
id = "transform"
kind = "transform"
title = "Pose"
[[parts]]
id = "rotation"
kind = "rotation"
title = "Orientation"
[[parts]]
id = "position"
kind = "position"
title = "Position"
"""
LINKS = """
[[parts]]
id = "links"
kind = "link_transforms"
title = "Link transforms"
convention = "{convention}"
"""
HEAD = 'title = "Unseen"\nsource = "none"\nstatement = "Nothing to see."\n'
# PUMA 560 by Craig, a seven-joint arm like KUKA's, and invented arms.
UNSEEN = {
    "puma": (
        "RRRRRR",
        "modified",
        "0 0 0 q1; 0 -90 d2 q2; a2 0 d3 q3; a3 -90 d4 q4; 0 90 0 q5; 0 -90 0 q6",
    ),
    "kuka": (
        "RRRRRRR",
        "standard",
        "0 -90 l1 q1; 0 90 0 q2; 0 90 l2 q3; 0 -90 0 q4; 0 -90 l3 q5; 0 90 0 q6; 0 0 l4 q7",
    ),
    "polar": ("RRP", "standard", "0 90 h q1; 0 90 0 q2+90; 0 0 q3 0"),
    "skew": ("RRR", "standard", "a1 35 d1 q1; a2 -50 d2 q2+20; a3 0 d3 q3"),
    "sliding": ("PRPR", "modified", "0 0 q1+h 0; a1 90 b q2; 0 90 q3 0; a2 0 c q4; a4 0 0 0"),
}


@dataclass(frozen=True)
class SpoiltRobot:
    """A robot: its exercise, and its table in SymPy."""

    # `joints` has an entry for each row: the number, the variable, and True for a prismatic joint;
    # or None for a fixed row.
    name: str
    text: str
    convention: str
    rows: tuple[tuple[sp.Expr, ...], ...]
    joints: tuple[tuple[int, sp.Symbol, bool] | None, ...]


def robots() -> Iterator[SpoiltRobot]:
    for file in sorted(shipped_folder().glob("*.toml")):
        text = file.read_text(encoding="utf-8")
        if "table = [\n" in text and "[robot]" in text and "[vary]" not in text:
            yield robot_of(file.stem, text.split("\n[[parts]]")[0])
    for name, (structure, convention, table) in UNSEEN.items():
        yield robot_of(name, HEAD + _setting(structure, convention, table))


def _setting(structure: str, convention: str, table: str) -> str:
    rows = [row.split() for row in table.split(";")]
    joints = [f"q{i + 1}" for i in range(len(structure))]
    cells = [
        [a, _degrees(alpha), d, "+".join(map(_degrees, theta.split("+")))]
        for a, alpha, d, theta in rows
    ]
    lengths = [_formula(cell) for row in rows for cell in (row[0], row[2])]
    letters = {str(symbol) for length in lengths for symbol in length.free_symbols}
    symbols = "\n".join(
        f'{name} = {{ kind = "length", description = "a length" }}'
        for name in sorted(letters - set(joints))
    )
    return (
        f'[robot]\nstructure = "{structure}"\nconvention = "{convention}"\njoints = {joints}\n'
        f"table = {cells}\n[symbols]\n{symbols}\n"
    )


def _degrees(cell: str) -> str:
    return f"{cell}deg" if cell.lstrip("-").isdigit() and cell != "0" else cell


def robot_of(name: str, setting: str) -> SpoiltRobot:
    robot = tomllib.loads(setting)["robot"]
    variables = [sp.Symbol(each) for each in robot["joints"]]
    first = int("".join(filter(str.isdigit, robot["joints"][0])))
    joints: list[tuple[int, sp.Symbol, bool] | None] = [
        (first + i, variable, letter == "P")
        for i, (variable, letter) in enumerate(zip(variables, robot["structure"], strict=True))
    ]
    rows = tuple(tuple(map(_formula, row)) for row in robot["table"])
    joints += [None] * (len(rows) - len(joints))
    text = setting + PARTS + LINKS.format(convention=robot["convention"])
    return SpoiltRobot(name, text, robot["convention"], rows, tuple(joints))


def _formula(cell: str) -> sp.Expr:
    terms = re.findall(r"([+-]?)\s*([A-Za-z]\w*|[\d.]+(?:deg)?)", cell)
    return sp.Add(*(_term(term) * (-1 if sign == "-" else 1) for sign, term in terms))


def _term(text: str) -> sp.Expr:
    if text.endswith("deg"):
        return sp.Rational(text.removesuffix("deg")) * sp.pi / 180
    return sp.Symbol(text) if text[0].isalpha() else sp.Rational(text)
