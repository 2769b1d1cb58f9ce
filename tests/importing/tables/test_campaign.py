"""Tables in many styles are imported as they are, refused, or asked about."""

from collections.abc import Callable

import numpy as np
import pytest
from dh_grader.importing import ImportedRobot

from tests.importing.tables.__main__ import outcomes
from tests.importing.tables.campaign import faults, greatest_difference, outcome, snapped
from tests.importing.tables.drawn import Cell, Drawn, pose, random_table, real_table, terms
from tests.importing.tables.programs import PROGRAMS
from tests.importing.tables.styles import STYLES, typed
from tests.shipped import REAL_ROBOTS

# The share of the texts that become an exercise; the others have a fixed row between joints, a
# first joint that counts negative, or no joint variables.
LEAST_MADE = 0.85


def test_there_are_twenty_styles_and_twenty_five_real_robots() -> None:
    assert len({style.name for style in STYLES}) == len(STYLES) == 20
    assert len(PROGRAMS) > 10
    assert len(REAL_ROBOTS) >= 25


@pytest.mark.parametrize("seed", [3])
def test_a_few_tables_are_imported_as_they_are(seed: int) -> None:
    found, counts = faults(outcomes(20, seed))
    assert found == []
    assert counts["same"] >= 25


@pytest.mark.long
@pytest.mark.parametrize("part", range(4))
def test_tables_are_imported_as_they_are(part: int) -> None:
    found, counts = faults(outcomes(100, 10 + part))
    assert found == []
    assert counts["same"] >= LEAST_MADE * (counts["same"] + counts["refused"])


@pytest.mark.campaign
def test_five_hundred_tables_are_imported_as_they_are(figure: Callable[[str], None]) -> None:
    found, counts = faults(outcomes(500, 1))
    figure(f"imported tables: {dict(counts)}")
    assert found == []
    assert counts["same"] >= LEAST_MADE * (counts["same"] + counts["refused"])


def test_the_calculation_of_the_tests_knows_a_planar_arm() -> None:
    rows = [{"a": Cell(0.5), "alpha": Cell(), "d": Cell(), "theta": Cell(motion=1)}] * 2
    reached = pose(rows, "standard", {}, [np.pi / 2, -np.pi / 2])
    assert reached[:3, 3] == pytest.approx([0.5, 0.5, 0])
    twisted = {"a": Cell(0.5), "alpha": Cell(90), "d": Cell(0.2), "theta": Cell(motion=1)}
    assert pose([twisted], "standard", {}, [0])[:3, 3] == pytest.approx([0.5, 0, 0.2])
    assert pose([twisted], "modified", {}, [0])[:3, 3] == pytest.approx([0.5, -0.2, 0])


def test_the_tests_see_a_changed_robot() -> None:
    rows = [
        {"a": Cell(0, {"h": 1.0}), "alpha": Cell(90), "d": Cell(), "theta": Cell(motion=1)},
        {"a": Cell(0.1), "alpha": Cell(), "d": Cell(), "theta": Cell(90, motion=-1)},
    ]
    drawn = Drawn("standard", ["R", "R"], rows)
    right = [["h", "-90deg", "0", "theta1"], ["0.1", "180deg", "0", "theta2 - 90deg"]]

    def file(table: list[list[str]]) -> str:
        joints = '"theta1", "theta2"'
        head = f'[robot]\nstructure = "RR"\nconvention = "standard"\njoints = [{joints}]\n'
        return f"{head}table = {table}\n".replace("'", '"')

    assert greatest_difference(drawn, rows, file(right)) < 1e-12
    for cell, other in (("theta2 - 90deg", "theta2 + 90deg"), ("h", "l1"), ("0.1", "100")):
        wrong = [[other if text == cell else text for text in row] for row in right]
        assert greatest_difference(drawn, rows, file(wrong)) > 1e-3


def test_the_tests_see_a_snap_that_the_rule_does_not_allow() -> None:
    rows = [{"a": Cell(), "alpha": Cell(44.96), "d": Cell(), "theta": Cell(motion=1)}]
    remark = "row 1, column alpha: 44.96deg became 45deg."
    with pytest.raises(AssertionError):
        snapped(rows, ImportedRobot(f"# {remark}\n", [remark]))


def test_sums_are_read_and_typed() -> None:
    assert terms("theta2 - 90deg", "theta2") == Cell(-90, {}, 1)
    assert terms("q3 + l1 - 0.5 h", "q3") == Cell(0, {"l1": 1.0, "h": -0.5}, 1)
    drawn = real_table("kinova-gen3")
    assert drawn.rows[1]["theta"] == Cell(180, {}, 1)
    rng = np.random.default_rng(0)
    written = typed(random_table(rng), STYLES[2], rng)
    assert written.text.startswith("Link | alpha | a (mm) | d (mm) | theta\n1 | ")
    assert outcome(real_table("ur5e"), typed(real_table("ur5e"), STYLES[0], rng)).result == "same"
