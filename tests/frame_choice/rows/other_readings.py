"""Wrong tables that once earned more points after one of their cells was emptied."""

from typing import NamedTuple

from tests.frame_choice.robots import GIVEN, MODIFIED, POLICIES, STANDARD, Policy, Robot
from tests.frame_choice.rows.student_rows import StudentRowsTexts as Texts

_SEVEN = tuple(f"q{i}" for i in range(1, 8))
_FREE_DIRECTIONS = next(policy for policy in POLICIES if policy.name == "free directions")


class OtherReading(NamedTuple):
    """A wrong table, and the cells that a test leaves empty."""

    robot: Robot
    policy: Policy
    convention: str
    texts: Texts
    row: int
    columns: tuple[int, ...] = (0, 1, 2, 3)

    @property
    def empty(self) -> Texts:
        return [
            ["" if i == self.row and j in self.columns else text for j, text in enumerate(cells)]
            for i, cells in enumerate(self.texts)
        ]


OTHER_READINGS = [
    # Of two choices of frames that are about as likely, the other one loses two units less.
    OtherReading(
        Robot(
            "kuka-kr-5-arc",
            "RRRRRR",
            STANDARD,
            tuple(f"theta{i}" for i in range(1, 7)),
            (
                ("0.18", "-(90*pi/180)", "0.4", "theta1"),
                ("0.6", "0", "0", "theta2 - (90*pi/180)"),
                ("0.12", "(90*pi/180)", "0", "theta3"),
                ("0", "-(90*pi/180)", "-0.62", "theta4"),
                ("0", "(90*pi/180)", "0", "theta5"),
                ("0", "(180*pi/180)", "-0.115", "theta6"),
            ),
            (),
        ),
        GIVEN,
        STANDARD,
        [
            ["0.18", "-pi/2", "0.4", "theta1"],
            ["0.6", "0", "0", "theta2 - pi/2"],
            ["0.12", "-pi/2", "0", "theta3"],
            ["0.12", "180", "0", "-theta4 + pi/2"],
            ["0", "-pi/2", "0", "theta5"],
            ["0.115", "0 - pi/2", "0.3", "theta5"],
        ],
        5,
    ),
    # One wrong row explains the table, but cells of several rows lose less.
    OtherReading(
        Robot(
            "a row of seven",
            "RRRRRRR",
            MODIFIED,
            _SEVEN,
            (
                ("0", "0", "l1", "q1-pi/2"),
                ("l2", "0", "l3", "q2"),
                ("l3", "0", "0.6398", "q3"),
                ("0", "0", "0", "q4"),
                ("0", "0", "0", "q5"),
                ("0.2", "0", "0.7480", "q6"),
                ("0.7058", "0", "0", "q7+pi/2"),
            ),
            ("l1", "l2", "l3"),
        ),
        GIVEN,
        MODIFIED,
        [
            ["0", "pi", "-l1 + 0.66", "-q1 - pi/2"],
            ["-l2", "0", "-l2 - l3 - 0.66", "-q2"],
            ["-l3", "0", "l2 - 0.6398", "-q3 + pi"],
            ["l3 - 0.49", "pi/4", "0", "pi"],
            ["0", "0", "-2*l3 + 0.88", "-q5"],
            ["-0.2", "0", "l3 - 1.678", "-q6"],
            ["-0.7058", "pi", "-0.54", "q7 - pi/2"],
        ],
        4,
        (3,),
    ),
    # An empty row at the end is a missing row, so that this table was judged as one of two rows.
    OtherReading(
        Robot(
            "no tool row",
            "RR",
            STANDARD,
            _SEVEN[:2],
            (("a1", "0", "0", "q1"), ("a2", "0", "0", "q2")),
            ("a1", "a2"),
        ),
        _FREE_DIRECTIONS,
        MODIFIED,
        [["0", "0", "0.3", "-q1"], ["a1", "0", "0", "q2"], ["a1", "0", "a1", "0"]],
        2,
    ),
    # In the student's frames, a wrong cell in a row of zeros cost more than the whole row.
    OtherReading(
        Robot(
            "a row of zeros",
            "RRR",
            MODIFIED,
            _SEVEN[:3],
            (
                ("0", "0", "0", "q1"),
                ("l1", "0", "0", "q2"),
                ("l2", "0", "0", "q3"),
                ("l3",) + ("0",) * 3,
            ),
            ("l1", "l2", "l3"),
        ),
        GIVEN,
        MODIFIED,
        [
            ["0", "q1", "0", "q1"],
            ["l1", "0", "l3", "q2 - pi"],
            ["-l2", "pi", "l3", "-q3 - pi"],
            ["l3", "pi", "0", "0"],
        ],
        0,
    ),
    # With two columns exchanged, the table lost more than as written.
    OtherReading(
        Robot(
            "exchanged columns",
            "RRRP",
            MODIFIED,
            _SEVEN[:4],
            (
                ("0", "0", "l1", "q1"),
                ("l2", "0", "0", "q2"),
                ("l3", "pi", "l4", "q3"),
                ("0", "0", "q4", "0"),
            ),
            ("l1", "l2", "l3", "l4"),
        ),
        GIVEN,
        MODIFIED,
        [
            ["l1 - l2", "0", "0", "q1 - pi"],
            ["-l2", "pi", "-l2", "-q2 - pi"],
            ["-l2 + l4", "0", "l3", "q3 + pi/2"],
            ["-q4 - l2", "pi", "0", "pi/2"],
            ["0", "pi", "0", "0"],
        ],
        2,
        (0,),
    ),
    # Without the row of the tool, a wrong row before it could lead to any tool.
    OtherReading(
        Robot(
            "RRPR without its tool row",
            "RRPR",
            STANDARD,
            ("q1", "q2", "q3", "q4"),
            (
                ("0.598", "pi/2", "0", "q1"),
                ("0", "pi/2", "0.314", "q2"),
                ("0", "-pi/2", "q3", "0"),
                ("0", "pi", "0", "q4+-pi/2"),
            ),
            (),
        ),
        GIVEN,
        MODIFIED,
        [
            ["0", "0", "0", "q1"],
            ["0.598", "pi/2", "0.314", "q2"],
            ["0", "pi/2", "q3", "0"],
            ["0.12", "-pi/2", "0", "q4 - pi/2"],
            ["0", "-pi/2", "0", "0"],
        ],
        4,
    ),
    # Two cells of one row are wrong; with more of its cells wrong, it needs no geometry.
    OtherReading(
        Robot(
            "RRRP with two wrong cells in a row",
            "RRRP",
            MODIFIED,
            ("q1", "q2", "q3", "q4"),
            (
                ("0", "0", "0.2", "q1"),
                ("l2", "0", "0", "q2+pi/2"),
                ("l3", "0", "0", "q3"),
                ("0", "pi", "q4", "0"),
            ),
            ("l1", "l2", "l3"),
        ),
        GIVEN,
        STANDARD,
        [
            ["-l2", "pi", "0.2", "q1 - pi"],
            ["-l3", "0", "0", "-q2 - pi/2"],
            ["0.5", "pi", "q4", "-q3 + pi"],
            ["l1", "pi", "-q4", "0"],
        ],
        2,
    ),
    # Directions are free, and a wrong first row makes the second one look wrong.
    OtherReading(
        Robot(
            "vertical-axes",
            "RPR",
            STANDARD,
            ("theta1", "d2", "theta3"),
            (("0.45", "0", "0", "theta1"), ("0.6", "0", "d2", "0"), ("0.15", "0", "0", "theta3")),
            (),
        ),
        _FREE_DIRECTIONS,
        STANDARD,
        [["0.4", "pi", "0.3", "theta1"], ["0.6", "0", "-d2", "0"], ["0.15", "0", "0", "-theta3"]],
        0,
    ),
]
