"""The kinds of slips in the robot's table, joints or lengths, likeliest first."""

from service.grading.diagnosis.upstream.slip import Slip
from service.grading.misconception import register

JOINT_VARIABLE_SIGN = register(
    of=Slip,
    rank=10,
    code="joint_variable_sign",
    rule="product",
    means="a joint moves in the wrong direction about or along its axis",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(q1 - q2), a1 s1 + a2 sin(q1 - q2)]"),
    unlike="[a1 c1 - a2 c12, a1 s1 - a2 s12]",
)
HOME_POSITION = register(
    of=Slip,
    rank=20,
    code="home_position",
    rule="product",
    means="the answer holds only for the home position",
    example=("planar-rr", "position", "[a1 + a2, 0]"),
    unlike={"2/1": "0"},
)
JOINT_VARIABLE_MISSING = register(
    of=Slip,
    rank=30,
    code="joint_variable_missing",
    rule="product",
    means="the variable of a joint is left out, so the joint does not move",
    example=("planar-rr", "position", "[(a1 + a2) c1, (a1 + a2) s1]"),
    unlike="[a1 c1, a1 s1]",
)
SIGN = register(
    of=Slip,
    rank=40,
    code="sign",
    rule="product",
    means="a length or an angle of the table has the wrong sign",
    example=("planar-rr", "position", "[a1 c1 - a2 c12, a1 s1 - a2 s12]"),
    unlike="[a1 c1, a1 s1]",
)
DISTANCE_LEFT_OUT = register(
    of=Slip,
    rank=50,
    code="distance_left_out",
    rule="product",
    means="a length of the table is left out",
    example=("planar-rr", "position", "[a1 c1, a1 s1]"),
    unlike="[a1 c1 - a2 c12, a1 s1 - a2 s12]",
)
QUARTER_TURN = register(
    of=Slip,
    rank=60,
    code="quarter_turn",
    rule="product",
    means="an angle of the table, or the zero position of a joint, is off by 90°",
    example=("planar-rr", "position", "[a1 c1 - a2 s12, a1 s1 + a2 c12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
COLUMNS_SWAPPED = register(
    of=Slip,
    rank=70,
    code="columns_swapped",
    rule="product",
    means="a and d are exchanged, throughout or in one row",
    example=(
        "planar-rr",
        "pose",
        "[c12, -s12, 0, 0; s12, c12, 0, 0; 0, 0, 1, a1 + a2; 0, 0, 0, 1]",
    ),
    unlike={"3/4": "a1"},
)
PARAMETER_SIGN = register(
    of=Slip,
    rank=80,
    code="parameter_sign",
    rule="product",
    means="one of a, α, d, θ has the wrong sign in every row",
    example=("three-link-cartesian", "position", "[-d3, -d2, d1]"),
    unlike="[d1, d2, d3]",
)
OTHER_CONVENTION = register(
    of=Slip,
    rank=90,
    code="other_convention",
    rule="convention",
    means="the table is multiplied out with the link transform of the other convention",
    example=(
        "spatial-rrr",
        "links",
        (
            "[c1, -s1, 0, R; 0, 0, -1, 0; s1, c1, 0, 0; 0, 0, 0, 1] ↵ [c2, -s2, 0, L1; s2, c2, 0, "
            "0; 0, 0, 1, 0; 0, 0, 0, 1] ↵ [c3, -s3, 0, L2; s3, c3, 0, 0; 0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"A1.2/4": "R*s2"},
)
LENGTHS_EXCHANGED = register(
    of=Slip,
    rank=100,
    code="lengths_exchanged",
    rule="product",
    means="two lengths of the table are exchanged",
    example=("planar-rr", "position", "[a2 c1 + a1 c12, a2 s1 + a1 s12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
OTHER_LENGTH = register(
    of=Slip,
    rank=110,
    code="other_length",
    rule="product",
    means="one length is used in place of another",
    example=("planar-rr", "position", "[a1 c1 + a1 c12, a1 s1 + a1 s12]"),
    unlike={"1/1": "a1*c1 - a2*c12"},
)
JOINT_VARIABLE_INDEX = register(
    of=Slip,
    rank=120,
    code="joint_variable_index",
    rule="product",
    means="a joint moves by the variable of another joint",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(2 q1), a1 s1 + a2 sin(2 q1)]"),
    unlike="[(a1 + a2) c1, (a1 + a2) s1]",
)
ANGLE_LEFT_OUT = register(
    of=Slip,
    rank=130,
    code="angle_left_out",
    rule="product",
    means="an angle of the table that is no multiple of 90° is left out",
    example=("arm", "position", "[a3 c1 c3 + b3 s1, a3 s1 c3 - b3 c1, a3 s3 + d2]"),
    unlike="[a3 c1 c3, a3 s1 c3, a3 s3 + d2]",
)
HALF_TURN = register(
    of=Slip,
    rank=140,
    code="half_turn",
    rule="product",
    means="an angle of the table, or the zero position of a joint, is off by 180°",
    example=(
        "planar-rr",
        "pose",
        "[-c12, s12, 0, a1*c1 - a2*c12; -s12, -c12, 0, a1*s1 - a2*s12; 0, 0, 1, 0; 0, 0, 0, 1]",
    ),
    unlike={"3/2": "1", "3/3": "0"},
)
JOINT_VARIABLE_DOUBLED = register(
    of=Slip,
    rank=150,
    code="joint_variable_doubled",
    rule="product",
    means="a joint variable counts twice",
    example=("planar-rr", "position", "[a1 c1 + a2 cos(q1 + 2 q2), a1 s1 + a2 sin(q1 + 2 q2)]"),
    unlike="[a1 c1 + a2 cos(2 q1), a1 s1 + a2 sin(2 q1)]",
)
ROW_ORDER = register(
    of=Slip,
    rank=160,
    code="row_order",
    rule="product",
    means="two rows, or their link transforms, are exchanged",
    example=("turret", "position", "[a3 c1 c3, a3 s1 c3, a3 s3]"),
    unlike="[a3 c1 c2, a3 s1 c2, a3 s2]",
)
# Listed only together with exchanged rows. Otherwise ``link_products`` names the missing link.
MISSING_LINK = register(of=Slip, rank=170, name="missing_link")
