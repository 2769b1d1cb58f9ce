"""Answers about the Stanford arm, which the benchmarks grade."""

import random
import re
from typing import Any

Rows = list[tuple[str, str, str, str]]

STANFORD: Rows = [
    ("0", "-90deg", "0", "theta1"),
    ("0", "90deg", "d2", "theta2"),
    ("0", "0", "d3", "0"),
    ("0", "-90deg", "0", "theta4"),
    ("0", "90deg", "0", "theta5"),
    ("0", "0", "d6", "theta6"),
]

# T_06, multiplied out by hand in the shorthand of the lectures.
T06 = [
    [
        "c1*(c2*(c4*c5*c6 - s4*s6) - s2*s5*c6) - s1*(s4*c5*c6 + c4*s6)",
        "c1*(-c2*(c4*c5*s6 + s4*c6) + s2*s5*s6) - s1*(-s4*c5*s6 + c4*c6)",
        "c1*(c2*c4*s5 + s2*c5) - s1*s4*s5",
        "c1*s2*d3 - s1*d2 + d6*(c1*c2*c4*s5 + c1*c5*s2 - s1*s4*s5)",
    ],
    [
        "s1*(c2*(c4*c5*c6 - s4*s6) - s2*s5*c6) + c1*(s4*c5*c6 + c4*s6)",
        "s1*(-c2*(c4*c5*s6 + s4*c6) + s2*s5*s6) + c1*(-s4*c5*s6 + c4*c6)",
        "s1*(c2*c4*s5 + s2*c5) + c1*s4*s5",
        "s1*s2*d3 + c1*d2 + d6*(c1*s4*s5 + c2*c4*s1*s5 + c5*s1*s2)",
    ],
    [
        "-s2*(c4*c5*c6 - s4*s6) - c2*s5*c6",
        "s2*(c4*c5*s6 + s4*c6) + c2*s5*s6",
        "-s2*c4*s5 + c2*c5",
        "c2*d3 + d6*(c2*c5 - c4*s2*s5)",
    ],
    ["0", "0", "0", "1"],
]


def table(rows: Rows) -> dict[str, Any]:
    return {"rows": [dict(zip(("a", "alpha", "d", "theta"), row, strict=True)) for row in rows]}


def turned_over() -> Rows:
    """Return a valid table of the robot in which z2 is reversed."""
    rows = list(STANFORD)
    rows[1] = ("0", "-90deg", "d2", "theta2")
    rows[2] = ("0", "180deg", "-d3", "0")
    return rows


def with_one_slip() -> Rows:
    """Return a table with one wrong cell: the sign of α2."""
    rows = list(STANFORD)
    rows[1] = ("0", "-90deg", "d2", "theta2")
    return rows


def with_two_slips() -> Rows:
    """Return a table with two wrong cells: d2 is missing, and the sign of α5 is wrong."""
    rows = list(STANFORD)
    rows[1] = ("0", "90deg", "0", "theta2")
    rows[4] = ("0", "-90deg", "0", "theta5")
    return rows


def in_other_convention() -> Rows:
    """Return the modified table, which is wrong in an exercise with the standard convention."""
    link = [("0", "0"), *((a, alpha) for a, alpha, _, _ in STANFORD[:-1])]
    return [
        (a, alpha, d, theta) for (a, alpha), (_, _, d, theta) in zip(link, STANFORD, strict=True)
    ]


def standing_still() -> list[list[str]]:
    return [[re.sub(r"\bs2\b", "0", re.sub(r"\bc2\b", "1", text)) for text in row] for row in T06]


def distinct(texts: list[list[str]], i: int, point: str = ".") -> list[list[str]]:
    """Make each text of the matrix different, so that no cache contains it."""
    # The numbers are decimals, or integers if `point` is empty. The grader tries to explain a wrong
    # entry with decimals as a rounded one; with integers it does not.
    return [
        [f"{text} + 0*{abs(i) + 2}{point}{j}{k}" for k, text in enumerate(row)]
        for j, row in enumerate(texts)
    ]


SPELLINGS = {
    "-90deg": ["-90deg", "-90°", "-pi/2", "-π/2", "-0.5 pi", "-1.5708"],
    "90deg": ["90deg", "90°", "pi/2", "π/2", "+90 deg", "1.5708"],
    "theta1": ["theta1", "q1", "θ1", "θ_1*", "th1", "q_1"],
    "theta2": ["theta2", "q2", "θ2", "θ_2*", "th2", "q_2"],
    "theta4": ["theta4", "q4", "θ4", "θ_4*", "th4", "q_4"],
    "theta5": ["theta5", "q5", "θ5", "θ_5*", "th5", "q_5"],
    "theta6": ["theta6", "q6", "θ6", "θ_6*", "th6", "q_6"],
    "d2": ["d2", "d_2", "d₂"],
    "d3": ["d3", "d3*", "q3", "d_3"],
    "d6": ["d6", "d_6", "d₆"],
    "0": ["0", "0.0", "0", "0"],
}


def one_student_s_table(i: int) -> Rows:
    choose = random.Random(i)
    rows = [[choose.choice(SPELLINGS[cell]) for cell in row] for row in STANFORD]
    if i % 3 == 0:
        rows[choose.randrange(6)][choose.randrange(4)] = "d2/2"
    return [(a, alpha, d, theta) for a, alpha, d, theta in rows]
