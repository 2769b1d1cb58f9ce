"""The figure of a student's table contains no text of the student."""

import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application

from tests.api.conftest import InProcess
from tests.browser.hostile import TEXTS
from tests.shipped import shipped_exercises

SHIPPED = shipped_exercises()
SVG = "{http://www.w3.org/2000/svg}"
# A revolute joint, a prismatic joint perpendicular to it, and a fixed row.
TABLE = {"structure": "RP", "rows": "0 90° d1 q1\n0 0 q2 0\n0.2 0 0 0"}


@pytest.fixture(scope="module")
def client() -> Iterator[httpx.Client]:
    app = application(SHIPPED)
    with httpx.Client(transport=InProcess(app), base_url="http://service") as made:
        yield made


def drawn(client: httpx.Client, **body: Any) -> ET.Element:
    response = client.post("/v1/frames", json={"figure": "light", **body})
    assert response.status_code == 200, response.text
    return ET.fromstring(response.json()["figure"])


def names(svg: ET.Element) -> set[str]:
    texts = ("".join(each.itertext()) for each in svg.iter(f"{SVG}text"))
    return {name for text in texts for name in text.split(", ")}


def kinds(svg: ET.Element) -> Counter[str]:
    return Counter(each.get("class", "").split()[0] for each in svg.iter() if each.get("class"))


def test_a_table_is_drawn_as_a_robot_with_its_frames(client: httpx.Client) -> None:
    svg = drawn(client, table=TABLE, symbols={"d1": 0.5}, joints=[[0.0, 0.4]])
    assert names(svg) == {f"{axis}{i}" for axis in "xyz" for i in range(4)}
    found = kinds(svg)
    assert (found["turning"], found["rod"], found["chain"]) == (1, 3, 0)
    assert found["sliding"] > 0
    # The first rod goes up by d1 = 0.5.
    up, *_ = svg.iterfind(".//*[@class='rod']")
    (x0, y0), (x1, y1) = (map(float, point.split(",")) for point in up.get("points", "").split())
    assert x0 == pytest.approx(x1)
    assert y1 < y0


@pytest.mark.long
def test_a_table_is_drawn_over_the_mechanism_of_its_exercise(client: httpx.Client) -> None:
    # Without a table, the figure contains no answer: no names, and no lines of a chain.
    for name, exercise in SHIPPED.items():
        if exercise.reference is not None:
            alone = drawn(client, exercise=name)
            assert (names(alone), kinds(alone)["chain"], kinds(alone)["frame"]) == (set(), 0, 0)
    right = [["a1", 0, 0, "theta1"], ["a2", 0, 0, "theta2"]]
    over = drawn(client, exercise="planar-rr", table={"rows": right}, joints=[[0.4, 0.7]])
    assert names(over) == {f"{axis}{i}" for axis in "xyz" for i in range(3)}
    assert kinds(over)["chain"] == 2
    # The last origin of a right table is the tool point of the gripper.
    point = over.find(".//*[@class='point']")
    assert point is not None
    tip = over.findall(".//*[@class='chain']")[-1].get("points", "").split()[-1]
    assert tip == f"{point.get('cx')},{point.get('cy')}"


def test_a_figure_contains_no_text_of_a_hostile_table(client: httpx.Client) -> None:
    rows = [[TEXTS[i % len(TEXTS)], 0, 0, "theta1"] for i in range(2)]
    for table in ({"rows": rows}, {"rows": TEXTS[0]}, {"rows": [["1e6", "1", "-1e6", "1"]] * 12}):
        svg = drawn(client, exercise="planar-rr", table=table)
        text = ET.tostring(svg, encoding="unicode")
        assert not re.search(r"script|onerror|javascript|nan|inf\b|href", text)
        assert {each.tag.removeprefix(SVG) for each in svg.iter()} <= {
            "svg", "title", "desc", "style", "rect", "g", "polygon", "polyline", "path", "ellipse",
            "circle", "text", "tspan", "linearGradient", "stop",
        }  # fmt: skip
    # With unreadable rows and no exercise, there is nothing to draw.
    body = {"figure": "auto", "table": {"structure": "R", "rows": TEXTS[1]}}
    assert "figure" not in client.post("/v1/frames", json=body).json()
