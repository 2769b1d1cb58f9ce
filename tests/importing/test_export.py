import ast

import numpy as np
import pytest
from dh_grader.importing.exercise_text import HomeRobot, toolbox_text, urdf_text
from dh_grader.importing.urdf import read_urdf
from dh_grader.kinematics import Convention, frames, standard_link


def robot(seed: int) -> HomeRobot:
    """Return a random robot."""
    rng = np.random.default_rng(seed)
    structure = "".join(rng.choice(["R", "R", "P"], size=rng.integers(1, 7)))
    rows = len(structure) + int(rng.random() < 0.5)
    table = rng.uniform(-2, 2, (rows, 4)) * (rng.random((rows, 4)) < 0.7)
    table[:, 1] = rng.choice([-1, 0, 0.5, 1, 2], rows) * np.pi / 2
    return HomeRobot(table, structure, {})


def pose(made: HomeRobot, values: np.ndarray) -> np.ndarray:
    table = made.table.copy()
    for i, letter in enumerate(made.structure):
        table[i, 2 if letter == "P" else 3] += values[i]
    return np.asarray(frames(table, Convention.STANDARD)[-1])


@pytest.mark.parametrize("seed", range(20))
def test_the_urdf_moves_as_the_table_does(seed: int) -> None:
    made = robot(seed)
    _, arm = read_urdf(urdf_text(made, 'a "robot" <&>').encode(), "tool")
    values = np.random.default_rng(seed).uniform(-2, 2, len(made.structure))
    assert arm.structure == made.structure
    assert arm.pose(values) == pytest.approx(pose(made, values), abs=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_the_script_has_the_same_links(seed: int) -> None:
    made = robot(seed)
    tree = ast.parse(toolbox_text(made, "robot's name"))
    calls = [
        (node.func.id, {each.arg: ast.literal_eval(each.value) for each in node.keywords})
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and "DH(" not in ast.dump(node)
    ]
    links = [(kind, numbers) for kind, numbers in calls if kind in ("RevoluteDH", "PrismaticDH")]
    reached = np.eye(4)
    for kind, numbers in links:
        free, fixed = ("theta", "d") if kind == "RevoluteDH" else ("d", "theta")
        row = {free: numbers["offset"], fixed: numbers[fixed]}
        reached = reached @ standard_link(numbers["a"], numbers["alpha"], row["d"], row["theta"])
    assert [kind[0] for kind, _ in links] == list(made.structure)
    expected = frames(made.table, Convention.STANDARD)[len(made.structure)]
    assert reached == pytest.approx(expected, abs=1e-9)
