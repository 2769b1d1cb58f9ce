"""Compare the animated frame in the 3D view with numpy's matrix products."""

import json
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Final

import httpx
import numpy as np
import pytest
from dh_grader.app import app
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.robot import Robot

from tests.api.conftest import InProcess
from tests.front.deno import TESTS, deno
from tests.shipped import shipped_exercises

SHIPPED: Final = shipped_exercises()
TOLERANCE: Final = 1e-9
PLACES: Final = (0, 0.3, 1, 1.75, 2, 2.5, 3, 3.1, 4)
# The moves of each convention as in the textbooks: an axis (0 for x, 2 for z), true for a turn, and
# the column of the number.
MOVES: Final = {
    "standard": ((2, True, 3), (2, False, 2), (0, False, 0), (0, True, 1)),
    "modified": ((0, True, 1), (0, False, 0), (2, True, 3), (2, False, 2)),
}


def matrix(axis: int, turns: bool, amount: float) -> np.ndarray:
    """Return the matrix of a rotation about an axis, or of a shift along it."""
    made = np.eye(4)
    direction = np.eye(3)[axis]
    if not turns:
        made[:3, 3] = amount * direction
        return made
    cross = np.cross(np.eye(3), direction)
    made[:3, :3] += np.sin(amount) * cross + (1 - np.cos(amount)) * cross @ cross
    return made


def partial_product(
    frame: object, values: Sequence[float], convention: str, at: float
) -> np.ndarray:
    product = np.array(frame)
    for i, (axis, turns, column) in enumerate(MOVES[convention]):
        product = product @ matrix(axis, turns, np.clip(at - i, 0, 1) * values[column])
    return product


def ghosts(rows: Sequence[object]) -> Any:
    script = TESTS / "units" / "rows" / "ghosts.js"
    found = deno("run", "--quiet", "--no-check", "--no-lock", str(script), written=json.dumps(rows))
    assert found.returncode == 0, found.stdout
    return json.loads(found.stdout)


def rows_of(client: httpx.Client, exercise: Exercise) -> list[dict[str, Any]]:
    assert isinstance(exercise.reference, Robot)
    rows = []
    values = [[0.4 * (i + 1) - 1 for i in range(len(exercise.joints))]]
    for convention, table in exercise.reference.tables.items():
        cells = [[cell.text() for cell in row] for row in table.rows]
        body = {
            "exercise": exercise.id,
            "table": {"rows": cells, "convention": convention},
            "joints": values,
        }
        drawn = client.post("/v1/frames", json=body).json()["table"]
        assert drawn["complete"], drawn
        for numbers, (frame, after) in zip(
            drawn["values"][0], pairwise(drawn["frames"][0]), strict=True
        ):
            row = {"frame": frame, "values": numbers, "convention": convention, "places": PLACES}
            rows.append({**row, "after": after})
    return rows


@pytest.mark.long
def test_a_ghost_goes_through_the_partial_products_to_the_frame_of_the_service() -> None:
    robots = [each for each in SHIPPED.values() if isinstance(each.reference, Robot)]
    with httpx.Client(transport=InProcess(app), base_url="http://service") as client:
        rows = [row for exercise in robots for row in rows_of(client, exercise)]
    rng = np.random.default_rng(1)
    for convention in MOVES:
        frame = partial_product(np.eye(4), rng.uniform(-3, 3, 4).tolist(), convention, 4).tolist()
        rows += [
            {"frame": frame, "values": values, "convention": convention, "places": PLACES}
            for values in rng.uniform(-7, 7, (50, 4)).tolist()
        ]
    assert {row["convention"] for row in rows} == set(MOVES)
    assert len(rows) > 200
    for row, found in zip(rows, ghosts(rows), strict=True):
        for at, ghost in zip(PLACES, found, strict=True):
            wanted = partial_product(row["frame"], row["values"], row["convention"], at)
            assert np.array(ghost) == pytest.approx(wanted, abs=TOLERANCE)
        if "after" in row:
            assert np.array(found[-1]) == pytest.approx(np.array(row["after"]), abs=TOLERANCE)
