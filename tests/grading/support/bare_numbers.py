"""Exercises without a robot and without symbols."""

from dataclasses import dataclass
from typing import Any

from tests.grading.support.submitting import one_part

TURN = [["1", "0", "0"], ["0", "0", "-1"], ["0", "1", "0"]]
TURNED_BACK = [["1", "0", "0"], ["0", "0", "1"], ["0", "-1", "0"]]
# A turn by 90 degrees about x, and the point (0.5, 0, 2): the row a = 0.5, α = 90°, d = 2, θ = 0.
POSE = [["1", "0", "0", "0.5"], ["0", "0", "-1", "0"], ["0", "1", "0", "2"], ["0", "0", "0", "1"]]
# This transform has no row, because its origin is on neither axis.
SKEW = [["1", "0", "0", "0.5"], ["0", "0", "-1", "2"], ["0", "1", "0", "0"], ["0", "0", "0", "1"]]
IDENTITY = [["1", "0", "0", "0"], ["0", "1", "0", "0"], ["0", "0", "1", "0"], ["0", "0", "0", "1"]]
ROW = {"a": "0.5", "alpha": "90deg", "d": "2", "theta": "0"}
SCREWS = [["0", "0", "1", "0", "-2", "0"], ["0", "1", "0", "0", "0", "0"]]
COMPONENTS = """components = [
    { name = "x", quantity = "length", expected = "0.5" },
    { name = "phi", quantity = "angle", expected = "60deg" },
    { name = "k", quantity = "number", expected = "3" },
]"""


@dataclass(frozen=True)
class BareExercise:
    """An exercise file with one part, and correct and wrong answers to the part."""

    kind: str
    fields: str
    right: Any
    wrong: tuple[Any, ...]

    @property
    def text(self) -> str:
        return one_part(self.kind, self.fields, setting="")


def _toml(rows: object) -> str:
    return str(rows).replace("'", '"')


BARE = (
    BareExercise(
        "vector",
        COMPONENTS,
        ["0.5", "60deg", "3"],
        (["0.7", "30deg", "-3"], ["0", "0", "0"], ["0.5", "60", "3"], ["1/0", "60deg", "3"]),
    ),
    BareExercise(
        "vector",
        'components = [{ name = "x", quantity = "length", expected = "0.5" }]',
        ["1/2"],
        (["0.7"], ["-0.5"], ["0"]),
    ),
    BareExercise(
        "position",
        'expected = ["0.5", "0", "2"]',
        ["0.5", "0", "2"],
        (["-0.5", "0", "-2"], ["2", "0", "0.5"], ["0", "0", "0"], ["0.5", "0", "2.1"]),
    ),
    BareExercise(
        "position", 'coordinates = "xy"\nexpected = ["0", "1"]', ["0", "1"], (["1", "0"],)
    ),
    BareExercise(
        "transform",
        f"expected = {_toml(POSE)}",
        POSE,
        (IDENTITY, [list(column) for column in zip(*POSE, strict=True)], [["0"] * 4] * 4, SKEW),
    ),
    BareExercise("rotation", f"expected = {_toml(TURN)}", TURN, (TURNED_BACK, [["0"] * 3] * 3)),
    BareExercise(
        "rotation",
        'steps = [{ axis = "x", angle = "90deg" }]',
        TURN,
        (TURNED_BACK, [["0"] * 3] * 3),
    ),
    BareExercise(
        "euler_angles",
        'sequence = "ZYX"\nexpected = ["30deg", "45deg", "60deg"]',
        ["30deg", "45deg", "60deg"],
        (["60deg", "45deg", "30deg"], ["30", "45", "60"], ["0", "0", "0"]),
    ),
    BareExercise(
        "euler_angles",
        'sequence = "ZYZ"\nexpected = ["30deg", "0", "60deg"]',
        ["90deg", "0", "0"],
        (["30deg", "10deg", "60deg"],),
    ),
    BareExercise("matrix", 'expected = [["3"]]', [["3"]], ([["-3"]], [["0"]])),
    BareExercise(
        "matrix",
        'expected = [["3", "2", "1"]]\nquantity = "length"',
        [["3", "2", "1"]],
        ([["-3", "-2", "-1"]], [["1", "2", "3"]], [["0", "0", "0"]]),
    ),
    BareExercise("matrix", 'expected = [["3"], ["2"]]', [["3"], ["2"]], ([["2"], ["3"]],)),
    BareExercise(
        "screw_axes",
        f'frame = "space"\nexpected = {_toml(SCREWS)}',
        SCREWS,
        ([["0", "0", "1", "0", "2", "0"], SCREWS[1]], SCREWS[:1], [["0"] * 6] * 2),
    ),
    BareExercise(
        "screw_axes",
        f'frame = "body"\ndirections = "free"\nexpected = {_toml(SCREWS[:1])}',
        [["0", "0", "-1", "0", "2", "0"]],
        ([["0", "0", "1", "0", "2", "0"]], [["0", "0", "0", "0", "0", "1"]]),
    ),
    BareExercise(
        "dh_row",
        f"transform = {_toml(POSE)}",
        ROW,
        ({"none": True}, {**ROW, "alpha": "-90deg"}, dict.fromkeys(ROW, "0")),
    ),
    BareExercise("dh_row", f"transform = {_toml(SKEW)}", {"none": True}, (ROW,)),
)
# The kinds that need a robot with a table.
OF_A_ROBOT = {"dh_table", "find_slip", "frames", "link_transforms"}
