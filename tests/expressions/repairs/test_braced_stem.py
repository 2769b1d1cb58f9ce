import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    (r"{\theta}_1", "braced_stem", r"{\theta}_1", r"\theta_1"),
    (r"{\theta}_{1}^{*} + \frac{\pi}{2}", "braced_stem", r"{\theta}_{1}",
     r"\theta_{1}^{*} + \frac{\pi}{2}"),
    (r"\cos{\theta}_{1}", "braced_stem", r"{\theta}_{1}", r"\cos\theta_{1}"),
    (r"\cos{q}_1", "braced_stem", "{q}_1", r"\cos q_1"),
    ("{θ}₁", "braced_stem", "{θ}₁", "θ₁"),
    ("{c}_{12}", "braced_stem", "{c}_{12}", "c_{12}"),
    (r"{\mathrm{c}}_1", "braced_stem", r"{\mathrm{c}}_1", r"\mathrm{c}_1"),
    ("{l}_{base}", "braced_stem", "{l}_{base}", "l_{base}"),
    (r"{l}_{1}{\theta}_1", "braced_stem", "{l}_{1}", r"l_{1}\theta_1"),
    # Here the braces hold what a root is of, and there is no such joint.
    (r"\sqrt{q}_1", "unknown_symbol", "q", None),
    (r"{\theta}_9", "unknown_symbol", r"\theta", None),
]  # fmt: skip

FINE = [
    (r"\mathrm{\theta}_1", "theta1"),
    (r"{\theta_1}", "theta1"),
    (r"{l_1}{\theta_1}", "l1*theta1"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
