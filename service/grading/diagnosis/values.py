"""What can be said of any wrong value, whether a table cell or a matrix entry."""

import numpy as np

from service.grading.diagnosis.case import WrongValue
from service.grading.findings import Finding

# The code of a wrong value that no known belief explains.
UNEXPLAINED = "value"


def undefined(case: WrongValue) -> Finding | None:
    """The formula has no value where the robot can be: 1/0, √−1, or beyond all bounds."""
    bad = np.flatnonzero(~np.isfinite(case.actual))
    if not bad.size:
        return None
    at = case.samples.at(int(bad[0]), case.expression.symbols)
    where = ", ".join(f"{name} = {number:g}" for name, number in at.items())
    return Finding(
        "undefined",
        f"{case.expression.text()} has no value{' at ' if where else ''}{where}: it divides by "
        f"zero, takes the root of a negative number, or grows beyond all bounds.",
        case.correction,
        values={**at},
    )


def differs(case: WrongValue, look: str) -> Finding:
    """No belief that is known explains the value: ``look``, and one counterexample."""
    at = case.samples.at(0, case.expression.symbols)
    return Finding(
        UNEXPLAINED, look, case.correction, values={**at, "yours": float(f"{case.actual[0]:.4g}")}
    )
