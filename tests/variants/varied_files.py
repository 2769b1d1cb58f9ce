"""Exercises with variants, for tests."""

from pathlib import Path

from dh_grader.catalogue import Exercise, load_exercise, read_exercise, shipped_folder

# --- Exercise files with variants, for tests

VARY = """
a1 = [0.3, 0.4, 0.5]
a2 = { from = 0.2, to = 0.6, step = 0.05 }
j2 = [{ sign = "", says = "up" }, { sign = "-", says = "down" }]
conditions = ["a1 > a2", "a1 + a2 <= 0.8"]
"""
_FILE = """
title = "An arm with links of {{{{a1}}}} m and {{{{a2}}}} m"
source = "a test"
statement = '''
In frame {{0}}, the links have {{{{a1}}}} m and {{{{ a2 }}}} m, together
{{{{a1 + a2}}}} m, so $\\frac{{a1}}{{2}}$.
Joint 2 points {{{{j2.says}}}}.
'''
[vary]
{vary}
[robot]
structure = "RR"
convention = "standard"
joints = ["theta1", "theta2"]
table = [
    ["{{{{a1}}}}", "{{{{j2.sign}}}}90deg", "0", "theta1"],
    ["{{{{a2}}}}", "{more}0", "0", "theta2"],
]
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
frames = "free"
"""


def varied_text(vary: str = VARY, more: str = "") -> str:
    """Return the text of an exercise file with variants."""
    # `vary` is its section `[vary]`; `more` is written before the α of the second DH row.
    return _FILE.format(vary=vary, more=more)


def varied(vary: str = VARY, more: str = "", name: str = "arm") -> Exercise:
    return read_exercise(Path(f"{name}.toml"), varied_text(vary, more))


# --- The shipped exercises that have variants

VARIED = ("planar-rr-numbers", "elbow-directions", "vertical-axes")


def shipped(name: str) -> Exercise:
    """Return a shipped exercise."""
    return load_exercise(shipped_folder() / f"{name}.toml")
