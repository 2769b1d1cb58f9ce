"""Write exercise files for tests, and return the remarks about them."""

from collections.abc import Callable

from dh_grader.authoring import Level, Remark, examine
from dh_grader.catalogue import Exercise

Make = Callable[[str], Exercise]

HEAD = """
title = "An arm"
source = "made for this test"
statement = "Two joints."
"""
ROBOT = """
[robot]
structure = "RP"
convention = "standard"
joints = ["theta1", "d2"]
table = [["0", "90deg", "a1", "theta1"], ["0", "0", "d2", "0"]]
[symbols]
a1 = { kind = "length", range = [0.3, 0.9], description = "a length" }
d2 = { kind = "length", range = [0.2, 0.8], description = "joint 2" }
"""
POSE = """
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
points = 4
"""


def remarks_on(make: Make, text: str, *changes: tuple[str, str]) -> list[Remark]:
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return examine(make(text))


def only(remarks: list[Remark], level: Level) -> Remark:
    [remark] = remarks
    assert remark.level is level
    return remark


def robot(structure: str, table: str) -> str:
    joints = [f"q{i + 1}" for i in range(len(structure))]
    return f"""
[robot]
structure = "{structure}"
convention = "standard"
joints = {joints}
table = {table}
[symbols]
a1 = {{ kind = "length", range = [0.3, 0.9], description = "a length" }}
"""
