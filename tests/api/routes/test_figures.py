import base64
import hashlib
import re
from collections.abc import Mapping

import httpx
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.figures import exercise_figure
from dh_grader.figures.drawing import Theme


@pytest.mark.long
def test_a_figure_is_the_drawing_of_the_exercise(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    answer = client.get("/v1/exercises/scara/figure.svg")
    assert answer.headers["content-type"] == "image/svg+xml"
    assert answer.text == exercise_figure(catalogue["scara"])
    dark = client.get("/v1/exercises/scara/figure.svg?theme=dark")
    assert dark.text == exercise_figure(catalogue["scara"], Theme.DARK)
    assert client.get("/v1/exercises/scara").json()["figure"] is True


@pytest.mark.long
def test_a_figure_runs_no_script_and_uses_only_its_own_style(client: httpx.Client) -> None:
    for theme in Theme:
        answer = client.get(f"/v1/exercises/planar-rr/figure.svg?theme={theme}")
        policy = answer.headers["content-security-policy"]
        style = re.findall(r"<style>(.*?)</style>", answer.text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(style[0].encode()).digest()).decode()
        assert "default-src 'none'" in policy
        assert f"style-src 'sha256-{digest}'" in policy


@pytest.mark.parametrize(
    ("path", "status", "kind"),
    [
        ("skara/figure.svg", 404, "unknown-exercise"),
        ("dh-conditions/figure.svg", 404, "no-figure"),
        ("scara/figure.svg?theme=pink", 422, "invalid-request"),
    ],
)
def test_a_figure_of_an_unknown_exercise_or_theme_is_refused(
    client: httpx.Client, path: str, status: int, kind: str
) -> None:
    answer = client.get(f"/v1/exercises/{path}")
    assert answer.status_code == status
    assert answer.json()["type"] == f"urn:dh-grader:problem:{kind}"


def test_an_exercise_without_a_robot_says_so(client: httpx.Client) -> None:
    assert client.get("/v1/exercises/dh-conditions").json()["figure"] is False
