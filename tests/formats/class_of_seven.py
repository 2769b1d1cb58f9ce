"""A graded class that is small enough to count by hand."""

from functools import cache

from dh_grader.formats.graded import GradedFile, GradedSubmission, answered
from dh_grader.grading import FeedbackLevel

from tests.formats.submissions import POSE, ROWS, graded, planar, submission

ANNA, BEN, CLEO, DANA, EMRE, FRITZ, GINA = range(7)

_TURNED = [ROWS[0], {**ROWS[1], "alpha": "pi/2"}, *ROWS[2:]]
_UNFINISHED = [*ROWS[:2], {**ROWS[2], "theta": "q3 +"}, *ROWS[3:], ROWS[1]]


@cache
def class_of_seven() -> tuple[GradedSubmission, ...]:
    """Return seven submissions to an exercise with a table and a pose."""
    # Anna's answers are correct. Ben and Cleo have the same wrong cell. Dana's table lacks the tool
    # row, and her pose is missing. Emre has an unreadable entry and one row too many. Fritz answers
    # nothing. Gina's file is empty.
    answers: dict[str, dict[str, object]] = {
        "anna": {"table": {"rows": ROWS}, "pose": POSE},
        "ben": {"table": {"rows": _TURNED}, "pose": POSE},
        "cleo": {"table": {"rows": _TURNED}, "pose": POSE},
        "dana": {"table": {"rows": ROWS[:3]}},
        "emre": {"table": {"rows": _UNFINISHED}, "pose": POSE},
        "fritz": {},
    }
    handed_in = [graded(each, name, FeedbackLevel.HINTS) for name, each in answers.items()]
    problem = GradedFile("gina.json", answered(planar()), None, "is empty")
    return (*handed_in, submission(problem, name="gina.json", learner="gina"))
