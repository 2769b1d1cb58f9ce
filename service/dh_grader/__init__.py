"""DH Grader: grades submissions of robotics students against a reference robot."""

import os
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from dh_grader.catalogue import Exercise
    from dh_grader.notebook import ShownReport

__all__ = ["VERSION", "grade"]

# The matrices of an arm are small: threads of numpy's linear algebra would only wait for each
# other, for seconds on a busy machine. numpy reads these variables when it is imported.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

# The installed version of the program.
VERSION: Final = version("dh-grader")


def grade(
    exercise: "str | Path | Exercise",
    answers: Mapping[str, object],
    *,
    angle_unit: str = "radians",
    feedback: str | None = None,
    language: str = "en",
) -> "ShownReport":
    r"""Grade answers to an exercise; return the report, which notebooks show as a page.

    ``exercise`` is an id, as in ``dh-grader exercises list``, the path of an exercise file
    (``….toml``), or a loaded exercise. ``answers`` has the answer to each part by the part's id,
    in the form of ``POST /v1/grade``: text, numbers and lists. Unanswered parts are missing.
    ``angle_unit`` ("radians" or "degrees") is the unit of angles without a unit. ``feedback`` is
    the level of the report: "full", "hints", "verdicts" or "score", by default the highest that
    the exercise allows students. ``language`` is "en", "de", "es", "fr" or "zh".

    >>> import dh_grader
    >>> table = "a, alpha, d, theta\na1, 0, 0, q1\na2, pi, 0, q2"
    >>> report = dh_grader.grade("planar-rr", {"table": table})
    >>> report.points, report.max_points
    (2.25, 17.0)
    >>> for row in report.parts[0].rows:
    ...     print(row.label, row.verdict, *(cell.label for cell in row.cells if cell.feedback))
    1 correct
    2 partial alpha
    >>> print(report.parts[0].rows[1].cells[1].feedback[0].message)
    α is not right: compare z1 and z2.

    Raises UnknownExerciseError, UnknownPartNameError, CatalogueError for a faulty exercise file,
    TypeError for an answer that JSON cannot hold, and ValueError for another option. Wrong and
    unreadable answers raise nothing.
    """
    # `import dh_grader` takes a twentieth of the time that loading the grader takes.
    from dh_grader.notebook import report_on

    return report_on(exercise, answers, angle_unit, feedback, language)
