"""Phrases that several kinds of messages contain."""

from typing import Final

from service.grading.feedback import Finding
from service.grading.misconception import says
from service.kinematics.chain import ALPHA, THETA
from service.translations import Sentence, listed, say

__all__ = [
    "AXES",
    "SYMBOLS",
    "UNIT_FACTORS",
    "axes_of_row",
    "change_every_sign",
    "other_length_unit",
    "wrong_throughout",
]
# The symbol of each table column, and the axis along or about which it is measured.
SYMBOLS = ("a", "α", "d", "θ")
AXES = ("x", "x", "z", "z")
# Lengths in another unit are too large by one of these factors.
UNIT_FACTORS: Final = (1000.0, 100.0, 10.0, 0.1, 0.01, 0.001)


def axes_of_row(axis: str, label: str, last: int) -> str:
    """Return the names of the two x or z axes that a row connects.

    ``axis`` is "x" or "z", and ``last`` is the number of the last joint.
    """
    # label is the label of the row. For some fixed rows the axes have no numbers; then the result
    # is "the two z axes".
    if label.isdecimal() and label != "0":
        return listed([f"{axis}{int(label) - 1}", f"{axis}{label}"])
    if label == "e":
        return say("{first} and the last {axis} axis", first=f"{axis}{last}", axis=axis)
    return say("the two {axis} axes", axis=axis)


def wrong_throughout(column: int) -> Sentence:
    """Return the message that a column of a table has the wrong sign in all rows."""
    symbol, axis = SYMBOLS[column], AXES[column]
    if column in (ALPHA, THETA):
        return say(
            "{symbol} has the wrong sign throughout: it is measured about {axis}, positive by the "
            "right-hand rule.",
            symbol=symbol,
            axis=axis,
        )
    return say(
        "{symbol} has the wrong sign throughout: it is measured along {axis}, positive in the "
        "direction of the axis.",
        symbol=symbol,
        axis=axis,
    )


def change_every_sign(column: int) -> Sentence:
    """Return the correction for a column in which every sign is wrong."""
    return say("Change the sign of every {symbol}.", symbol=SYMBOLS[column])


def other_length_unit(times: float) -> Finding:
    """Return the message that all lengths are wrong by the factor ``times``."""
    if times > 1:
        return says(
            say(
                "The lengths are {factor} times too large: in which unit does the exercise give "
                "them?",
                factor=round(times),
            ),
            say("Divide each length by {factor}.", factor=round(times)),
        )
    return says(
        say(
            "The lengths are {factor} times too small: in which unit does the exercise give them?",
            factor=round(1 / times),
        ),
        say("Multiply each length by {factor}.", factor=round(1 / times)),
    )
