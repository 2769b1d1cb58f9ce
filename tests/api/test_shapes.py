"""The service describes the shape of each answer, such as 4 × 4."""

from typing import Any

import httpx
import pytest


def shape(client: httpx.Client, exercise: str, part_id: str) -> dict[str, Any]:
    parts = client.get(f"/v1/exercises/{exercise}").json()["parts"]
    [found] = [part["shape"] for part in parts if part["id"] == part_id]
    return dict(found)


THREE, FOUR, SIX = ["1", "2", "3"], ["1", "2", "3", "4"], ["1", "2", "3", "4", "5", "6"]


def components(*pairs: tuple[str, str]) -> list[dict[str, str]]:
    return [{"name": name, "quantity": quantity} for name, quantity in pairs]


SHAPES: dict[tuple[str, str], dict[str, Any]] = {
    ("planar-rpr-poe", "home"): {"form": "matrix", "columns": FOUR, "rows": FOUR},
    ("fundamental-rotations", "about-x"): {"form": "matrix", "columns": THREE, "rows": THREE},
    ("planar-rr", "position"): {
        "form": "list",
        "rows": ["1", "2"],
        "components": components(("x", "length"), ("y", "length")),
    },
    ("planar-rr", "task-space"): {
        "form": "list",
        "rows": THREE,
        "components": components(("p_x", "length"), ("p_y", "length"), ("φ", "angle")),
    },
    ("spherical-wrist", "zyz"): {
        "form": "list",
        "rows": THREE,
        "components": components(("about z", "angle"), ("about y", "angle"), ("about z", "angle")),
        "sequence": "ZYZ",
        "axes": "moving",
    },
    ("planar-rpr-poe", "body-screws"): {
        "form": "screw_axes",
        "columns": SIX,
        "rows": THREE,
        "frame": "body",
        "directions": "given",
    },
    ("simple-twist", "pitch"): {
        "form": "screw_axes",
        "columns": SIX,
        "rows": ["1"],
        "frame": "space",
        "directions": "given",
    },
    ("dh-conditions", "first"): {
        "form": "dh_row",
        "columns": ["a", "alpha", "d", "theta"],
        "convention": "standard",
    },
}


@pytest.mark.parametrize("place", SHAPES)
def test_the_shape_of_an_answer(place: tuple[str, str], client: httpx.Client) -> None:
    assert shape(client, *place) == SHAPES[place]


def test_an_exercise_without_a_robot_has_no_structure(client: httpx.Client) -> None:
    listed = {each["id"]: each for each in client.get("/v1/exercises").json()["exercises"]}
    assert listed["composite-rotations"]["structure"] is None
    assert listed["planar-rpr-poe"]["structure"] == "RPR"
    assert "structure" not in client.get("/v1/exercises/composite-rotations").json()


@pytest.mark.parametrize("exercise", ["rigid-motion-chain", "simple-twist", "planar-rpr-poe"])
def test_no_formula_of_an_answer_is_shown(exercise: str, client: httpx.Client) -> None:
    shown = client.get(f"/v1/exercises/{exercise}").json()
    for part in shown["parts"]:
        fields = {"id", "title", "prompt", "prompt_html", "kind", "points", "marking", "shape"}
        assert set(part) == fields
    assert "expected" not in str(shown["parts"])
