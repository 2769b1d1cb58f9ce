"""Import the URDF files of real arms as tables."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from dh_grader.importing.urdf import home_axes, placed, read_urdf, tips

from tests.importing.test_frames import by_table
from tests.importing.urdf_texts import Part, tip, turned

ARMS = Path(__file__).parent / "arms"
LENGTHS = {
    # Universal Robots, DH parameters of the e-Series.
    "ur5e": [0.0996, 0.0997, 0.1333, 0.1625, 0.3922, 0.425],
    # Franka Control Interface, DH parameters.
    "panda": [0.0825, 0.088, 0.107, 0.316, 0.333, 0.384],
    # ABB, product specifications of IRB 120 and IRB 4600-40/2.55.
    "irb120": [0.07, 0.072, 0.27, 0.29, 0.302],
    "irb4600": [0.135, 0.175, 0.495, 1.095, 1.27],
    # Rethink Robotics: offsets 69 mm and 10 mm, forearm 374.29 mm; the others follow from the
    # mount (270.35 mm is to the shoulder) and the gripper of this file.
    "baxter": [0.01, 0.069, 0.28139, 0.36442, 0.37429, 0.38722],
}
"""The lengths of each table, sorted, in metres."""
# Two of the joint angles are not multiples of 15° because a link is bent: the axes at its ends are
# joined by a line that is inclined, by the arctangent of these lengths in the file.
BENT = {
    "xarm6": (0.0535, 0.2845), "px100": (0.035, 0.1), "rx150": (0.05, 0.15),
    "rx200": (0.05, 0.2), "vx300": (0.05955, 0.3), "vx300s": (0.05955, 0.3),
    "wx250": (0.04975, 0.25), "wx250s": (0.04975, 0.25),
}  # fmt: skip
# Hand-made arms, exported from a drawing program with crooked axes: their angles are no multiples.
CROOKED = {"so100", "so101"}
NAMES = sorted(file.stem for file in ARMS.glob("*/*.urdf"))


def file_of(name: str) -> Path:
    """Return the URDF file of an arm."""
    [file] = ARMS.glob(f"*/{name}.urdf")
    return file


def parts_of(file: Path) -> list[Part]:
    def numbers(joint: ElementTree.Element, part: str, name: str, default: str) -> list[float]:
        found = joint.find(part)
        text = default if found is None else found.get(name, default)
        return [float(word) for word in text.split()]

    return [
        Part(
            joint.get("type", ""),
            numbers(joint, "origin", "xyz", "0 0 0"),
            numbers(joint, "origin", "rpy", "0 0 0"),
            numbers(joint, "axis", "xyz", "1 0 0"),
        )
        for joint in ElementTree.parse(file).getroot().findall("joint")
    ]


def test_there_are_thirty_arms() -> None:
    assert len(NAMES) == len(set(NAMES)) >= 30


@pytest.mark.parametrize("name", LENGTHS)
def test_a_real_arm_has_its_published_lengths(name: str) -> None:
    data = file_of(name).read_bytes()
    arm, _ = read_urdf(data, *tips(data))
    table = placed(*home_axes(arm)).table
    lengths = sorted({abs(round(float(each), 6)) for each in table[:, [0, 2]].flat} - {0.0})
    assert lengths == pytest.approx(LENGTHS[name], abs=1e-5)


@pytest.mark.parametrize("name", NAMES)
def test_a_real_arm_moves_as_its_file(name: str) -> None:
    file = file_of(name)
    arm, _ = read_urdf(file.read_bytes(), *tips(file.read_bytes()))
    made = placed(*home_axes(arm))
    parts = parts_of(file)
    rng = np.random.default_rng(1)
    for _ in range(10):
        values = rng.uniform(-np.pi, np.pi, len(arm.structure))
        place, turn = tip(parts, list(values))
        reached = by_table(arm, made, values)
        assert np.linalg.norm(reached[:3, 3] - place) < 5e-4
        for axis in np.eye(3):
            assert reached[:3, :3] @ axis == pytest.approx(turned(turn, list(axis)), abs=2e-4)


@pytest.mark.parametrize("name", sorted({*NAMES} - CROOKED))
def test_the_angles_of_a_real_arm_are_clean(name: str) -> None:
    data = file_of(name).read_bytes()
    arm, _ = read_urdf(data, *tips(data))
    table = placed(*home_axes(arm)).table
    steps = np.degrees(table[:, [1, 3]]) / 15
    # A file that rounds π/2 to 1.5708 does not leave 90.0002°.
    assert steps[:, 0] == pytest.approx(np.round(steps[:, 0]), abs=1e-9)
    odd = steps[np.abs(steps[:, 1] - np.round(steps[:, 1])) > 1e-9, 1] * 15
    if name not in BENT:
        assert odd.size == 0
        return
    aside, along = BENT[name]
    assert len(odd) == 2
    bend = np.degrees(np.arctan2(aside, along))
    # The angles are the bend, or differ from it by quarter turns.
    folded = np.abs((odd + 45) % 90 - 45)
    assert np.minimum(np.abs(folded - bend), np.abs(90 - folded - bend)).max() < 1e-2
