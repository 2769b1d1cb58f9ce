"""The rules of DH and of kinematics that hints explain, each in three sentences.

A rule never contains a value of the answer. Its sentences ``look`` and ``apply`` may name rows,
axes and frames of the exercise, by fields such as ``{row}`` and ``{z_before}``.
"""

# The field ``rule`` in a record of a misconception names a rule. ``look`` and ``apply`` may have
# these fields: ``{row}``, the axes ``{z_before}`` and ``{z}``, ``{x_before}`` and ``{x_here}``, the
# axis ``{x}`` of the parameters a and α, the axis ``{axis}`` of d and θ, and ``{entry}``, the place
# in an answer that is not a table.

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from service.grading.report import RuleName
from service.kinematics.dh import Convention
from service.translations import say, template


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: where to look, what the rule says, and how it applies to a row.

    ``modified`` is the statement in the modified convention if it differs from ``statement``.
    ``pictured`` are the parameters in the rule's picture; without them, there is no picture.
    """

    # ``look`` and ``apply`` are templates, the other texts are sentences.

    title: str
    look: str
    statement: str
    apply: str
    modified: str = ""
    pictured: tuple[str, ...] = ()

    def stated(self, convention: Convention) -> str:
        """Return what the rule says in a convention."""
        is_modified = convention is Convention.MODIFIED
        return self.modified if is_modified and self.modified else self.statement


# The screens of *DH in ten minutes* that explain a rule.
SCREENS: Final[Mapping[RuleName, str]] = {
    "link_length": "a",
    "link_twist": "alpha",
    "link_offset": "d",
    "joint_angle": "theta",
    "joint_variable": "theta",
    "rows": "table",
    "convention": "table",
    "frame_z": "frames",
    "frame_origin": "frames",
    "frame_x": "frames",
}

RULES: Final[Mapping[RuleName, Rule]] = {
    "link_length": Rule(
        say("Link length a"),
        template(
            "Look at {z_before} and {z}: a in row {row} is the distance between these two axes."
        ),
        say(
            "a_i is the distance from z_{{i-1}} to z_i, measured along x_i. x_i lies on the common "
            "normal of the two axes."
        ),
        template(
            "In row {row}, draw the shortest line from {z_before} to {z}: {x} lies along it. Go "
            "from {z_before} to {z}: a is this way, positive in the direction of {x}. If the axes "
            "intersect or are one line, there is no way to go."
        ),
        say(
            "a_{{i-1}} is the distance from z_{{i-1}} to z_i, measured along x_{{i-1}}. x_{{i-1}} "
            "lies on the common normal of the two axes. In this convention it is in row i."
        ),
        ("a",),
    ),
    "link_twist": Rule(
        say("Link twist α"),
        template("Look at {z_before} and {z}: α in row {row} is the angle between these two axes."),
        say("α_i is the angle from z_{{i-1}} to z_i about x_i, by the right-hand rule."),
        template(
            "In row {row}, point your right thumb along {x}. Turn {z_before} until it points as "
            "{z}: this angle is α. It is positive if you turn as your fingers curl, else "
            "negative. It is no angle at all if both axes already point the same way."
        ),
        say(
            "α_{{i-1}} is the angle from z_{{i-1}} to z_i about x_{{i-1}}, by the right-hand "
            "rule. In this convention it is in row i."
        ),
        ("alpha",),
    ),
    "link_offset": Rule(
        say("Link offset d"),
        template(
            "Look along {axis}: d in row {row} is the distance between {x_before} and {x_here}."
        ),
        say(
            "d_i is the distance from x_{{i-1}} to x_i, measured along z_{{i-1}}. The variable of "
            "a sliding joint is part of it."
        ),
        template(
            "In row {row}, go along {axis} from the point where it meets {x_before} to the point "
            "where it meets {x_here}. d is this way; it is positive in the direction of {axis}. "
            "If the joint slides, its variable is part of the way."
        ),
        say(
            "d_i is the distance from x_{{i-1}} to x_i, measured along z_i. The variable of a "
            "sliding joint is part of it."
        ),
        ("d",),
    ),
    "joint_angle": Rule(
        say("Joint angle θ"),
        template("Look down {axis}: θ in row {row} is the angle between {x_before} and {x_here}."),
        say(
            "θ_i is the angle from x_{{i-1}} to x_i about z_{{i-1}}, by the right-hand rule. The "
            "variable of a turning joint is part of it."
        ),
        template(
            "In row {row}, point your right thumb along {axis}. Turn {x_before} until it points "
            "as {x_here}: this angle is θ. If the joint turns, do this where its variable is "
            "zero; the angle that you find there is added to the variable."
        ),
        say(
            "θ_i is the angle from x_{{i-1}} to x_i about z_i, by the right-hand rule. The "
            "variable of a turning joint is part of it."
        ),
        ("theta",),
    ),
    "joint_variable": Rule(
        say("Joint variable"),
        template(
            "Look at the joint of row {row}: which way does it move, and along or about which axis?"
        ),
        say(
            "Each joint has its own variable, once and in its own row: in θ if the joint turns "
            "about z_{{i-1}}, in d if it slides along z_{{i-1}}. Everything else in the row is "
            "constant."
        ),
        template(
            "The joint of row {row} moves about or along {axis}. Let it move alone, in the "
            "positive direction of {axis}: its variable grows, and only θ or only d grows with "
            "it. Write the variable of this joint there and nowhere else."
        ),
        say(
            "Each joint has its own variable, once and in its own row: in θ if the joint turns "
            "about z_i, in d if it slides along z_i. Everything else in the row is constant."
        ),
        ("d", "theta"),
    ),
    "rows": Rule(
        say("Rows of the table"),
        template("Look at the frames, and count them from the base to the end effector."),
        say(
            "Row i leads from frame {{i-1}} to frame i. There is one row for each joint, in the "
            "order of the joints, and one more only if the end effector has a frame of its own."
        ),
        template(
            "Write the frames in order. For each row, say from which frame to which it leads: the "
            "next row must begin where this one ends, and the last one must end at the end "
            "effector."
        ),
        pictured=("theta", "d", "a", "alpha"),
    ),
    "convention": Rule(
        say("The four moves of a row"),
        template("Look at the order of the four moves in a row, and at the axis of each."),
        say(
            "Standard convention: turn by θ_i about z_{{i-1}}, go d_i along z_{{i-1}}, go a_i "
            "along x_i, turn by α_i about x_i. z_i is the axis of joint i+1."
        ),
        template(
            "Do the four moves of one row with your hand or with a paper frame. You begin at the "
            "frame before, and you must end at the frame of the row. Then compare: which of the "
            "four moves was not the one that you wrote?"
        ),
        say(
            "Modified convention: turn by α_{{i-1}} about x_{{i-1}}, go a_{{i-1}} along "
            "x_{{i-1}}, turn by θ_i about z_i, go d_i along z_i. z_i is the axis of joint i."
        ),
        ("theta", "d", "a", "alpha"),
    ),
    "angle_unit": Rule(
        say("Units of angles"),
        template("Look at the unit of the angle in {entry}."),
        say("A number without a unit is read in the unit of the form. A full turn is 360° or 2π."),
        template(
            "Say the angle of {entry} as a part of a full turn. Then write it with its unit, or "
            "choose the unit of the form."
        ),
    ),
    "product": Rule(
        say("The product of link transforms"),
        template(
            "Look at the table of the robot, and at the order in which the transforms follow."
        ),
        say(
            "The pose is the product of all link transforms, from the base on the left to the end "
            "effector on the right. Each one is computed from its own row only."
        ),
        template(
            "Set all joint variables to zero and draw the arm. Compare {entry} with the drawing. "
            "Then move one joint after the other, the last one first: with the first joint at "
            "which the drawing and {entry} disagree, begin to search."
        ),
    ),
    "rotation_columns": Rule(
        say("The columns of a rotation"),
        template("Look at the column of {entry}: it is one axis of the last frame."),
        say(
            "The columns of a rotation are the axes x, y and z of the last frame, each by its "
            "components along the axes of the first frame."
        ),
        template(
            "Find the axis that belongs to {entry} in the drawing. Say which way it points, in "
            "the frame of the base: each row of the column is its component along one axis of "
            "that frame."
        ),
    ),
    "position_vector": Rule(
        say("The position"),
        template("Look at the vector from the origin of the first frame to the point."),
        say(
            "The position is the vector from the origin of the first frame to the point, by its "
            "components along the axes of the first frame."
        ),
        template(
            "Go along the links from the origin to the point. Write down the part of each link "
            "along the axis of {entry}, with its sign, and add these parts."
        ),
    ),
    "frame_z": Rule(
        say("The axis z of a frame"),
        template("Look at the joint whose axis z of this frame lies along: {entry}."),
        say("z_i lies along the axis of joint i+1, in either direction."),
        template(
            "Draw the axes of all joints as long lines. Count along the arm which of them this "
            "frame needs, and put z of {entry} on that line. Both directions are right."
        ),
        say("z_i lies along the axis of joint i, in either direction."),
    ),
    "frame_origin": Rule(
        say("The origin of a frame"),
        template(
            "Look at the two neighbouring axes z at {entry}: do they meet, are they parallel, or "
            "neither?"
        ),
        say(
            "The origin of frame i lies on z_i, where the common normal of z_{{i-1}} and z_i "
            "meets it. If these axes intersect, it is the point where they do. If they are "
            "parallel, any point of z_i is right."
        ),
        template(
            "For {entry}, draw the shortest line between the two axes. The origin is the point "
            "where this line meets z of this frame."
        ),
        say(
            "The origin of frame i lies on z_i, where the common normal of z_i and z_{{i+1}} "
            "meets it. If these axes intersect, it is the point where they do. If they are "
            "parallel, any point of z_i is right."
        ),
    ),
    "frame_x": Rule(
        say("The axis x of a frame"),
        template("Look at x of {entry} and at the two neighbouring axes z."),
        say("x_i is at a right angle to z_{{i-1}} and to z_i, and crosses z_{{i-1}}."),
        template(
            "At {entry}, draw the shortest line between the two axes: x lies along it, in either "
            "direction. If the axes intersect, x is at a right angle to both."
        ),
        say("x_i is at a right angle to z_i and to z_{{i+1}}, and crosses z_{{i+1}}."),
    ),
    "inverse": Rule(
        say("The inverse of a transform"),
        template("Look at which frame is described in which."),
        say(
            "The inverse has the transposed rotation. Its position is the old one, turned by the "
            "transposed rotation and then reversed."
        ),
        template(
            "Imagine that you stand in the other frame. For {entry}, ask: where does the first "
            "origin lie, and which way do the first axes point, seen from there?"
        ),
    ),
    "sine_and_cosine": Rule(
        say("Sine and cosine"),
        template("Look at the angle of each term in {entry}: from which axis is it counted?"),
        say(
            "A link at an angle from an axis reaches its length times the cosine along this axis, "
            "and its length times the sine across it."
        ),
        template(
            "Draw each term of {entry} as a right triangle. The side next to the angle has the "
            "cosine, the side opposite the sine. The sign is that of the axis which the side runs "
            "along."
        ),
    ),
    "angle_sum": Rule(
        say("Sums of joint angles"),
        template("Look at the joints before each link in {entry}."),
        say(
            "The direction of a link is the sum of the angles of all joints before it with "
            "parallel axes. The sum is inside the sine and cosine."
        ),
        template(
            "For each term of {entry}, ask which joints turn this link if they move alone. The "
            "angles of these joints, and no others, are in its sum."
        ),
    ),
    "atan2": Rule(
        say("The two arguments of atan2"),
        template("Look at the quadrant of the angle in {entry}."),
        say(
            "atan2 takes the value that belongs to the sine first, and the one that belongs to the "
            "cosine second. The signs of both decide the quadrant."
        ),
        template(
            "For {entry}, name the sine and the cosine of the angle. Write them into atan2 in this "
            "order, and try an angle in each quadrant."
        ),
    ),
    "euler_sequence": Rule(
        say("The sequence of turns"),
        template("Look at the sequence of axes in the question, and whether the axes move."),
        say(
            "Turns about moving axes are multiplied from left to right, turns about fixed axes "
            "from right to left. Each angle belongs to its axis in the sequence."
        ),
        template(
            "Do the turns one after the other, with a book or your hand. For {entry}, say about "
            "which axis the turn is, and with which sign."
        ),
    ),
    "elementary_turn": Rule(
        say("A turn about one axis"),
        template("Look at the axis of the turn in {entry}, and at its direction."),
        say(
            "A positive turn follows the right-hand rule: the thumb points along the axis, and the "
            "fingers curl from x to y about z, from y to z about x, and from z to x about y."
        ),
        template(
            "For {entry}, point your right thumb along the axis of the turn. See where the other "
            "two axes go if you turn by a small angle: their signs are those of the sines."
        ),
    ),
    "screw_axis": Rule(
        say("The screw axis of a joint"),
        template(
            "Look at the axis of the joint in its home position: its direction and a point on it."
        ),
        say(
            "ω is the unit vector along the axis, and v = −ω × q with any point q on the axis. "
            "For a sliding joint, ω vanishes and v is its direction."
        ),
        template(
            "For {entry}, hold the arm at home. Name ω by the right-hand rule and choose a point "
            "q on the axis, both in the frame of the question. Then compute v from them."
        ),
    ),
    "exponentials": Rule(
        say("The product of exponentials"),
        template("Look at the order of the factors and at the side on which M is."),
        say(
            "With screw axes in the base frame, the exponentials follow from the first joint to "
            "the last, and M is on the right. With axes in the end-effector frame, M is on the "
            "left."
        ),
        template(
            "Set all joint variables to zero: {entry} must be that of M. Then move the last joint "
            "alone and compare again, then the one before."
        ),
    ),
    "dependence": Rule(
        say("What a formula depends on"),
        template("Look at which joints and lengths can change {entry} at all."),
        say(
            "A formula contains exactly those joint variables and lengths that change its value. A "
            "length has the unit of a length in each of its terms; an angle has none."
        ),
        template(
            "Move each joint alone in your mind, then make each link longer. Whatever changes "
            "{entry} must be in its formula, and nothing else."
        ),
    ),
}

# The rule of each column of a DH table.
OF_COLUMN: Final[Mapping[str, RuleName]] = {
    "a": "link_length",
    "alpha": "link_twist",
    "d": "link_offset",
    "theta": "joint_angle",
}
