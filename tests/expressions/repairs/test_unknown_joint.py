import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("theta7", "unknown_joint", "theta7", None),
    ("q7", "unknown_joint", "q7", None),
    ("θ7", "unknown_joint", "θ7", None),
    ("q_7", "unknown_joint", "q_7", None),
    ("q0", "unknown_joint", "q0", None),
    ("theta0", "unknown_joint", "theta0", None),
    (r"\theta_7", "unknown_joint", r"\theta_7", None),
    ("theta3", "unknown_joint", "theta3", None),
    ("θ₃", "unknown_joint", "θ₃", None),
    ("theta12", "unknown_joint", "theta12", "(theta1 + theta2)"),
    ("θ12", "unknown_joint", "θ12", "(theta1 + theta2)"),
    ("cos(θ12)", "unknown_joint", "θ12", "cos(theta1 + theta2)"),
    (r"\theta_{12}", "unknown_joint", r"\theta_{12}", r"(\theta_{1} + \theta_{2})"),
    (r"\cos\theta_{12}", "unknown_joint", r"\theta_{12}", r"\cos(\theta_{1} + \theta_{2})"),
    (r"\sin\theta_{12}\cos\theta_1", "unknown_joint", r"\theta_{12}",
     r"\sin(\theta_{1} + \theta_{2})\cos\theta_1"),
    (r"\cos\theta_{12}\sin\theta_{45}", "unknown_joint", r"\theta_{12}",
     r"\cos(\theta_{1} + \theta_{2})\sin(\theta_{4} + \theta_{5})"),
    ("cos(q12)c1", "unknown_joint", "q12", "cos(theta1 + theta2)c1"),
    ("q7c1", "unknown_joint", "q7", None),
    # Joint 3 slides: it has no angle to add.
    ("cos(θ123)", "unknown_joint", "θ123", "cos(theta1 + theta2)"),
    ("θ13", "unknown_joint", "θ13", None),
    ("θ127", "unknown_joint", "θ127", None),
    ("cos(theta12)", "unknown_joint", "theta12", "cos(theta1 + theta2)"),
    ("sin(q12)", "unknown_joint", "q12", "sin(theta1 + theta2)"),
    ("q123", "unknown_joint", "q123", "(theta1 + theta2)"),
]  # fmt: skip

FINE = [
    ("q6", "theta6"),
    ("q3", "d3"),
    ("θ₁ + θ₂", "theta1 + theta2"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
