"""The joints of real arms, from files under free licences, become their published tables."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from service.importing.axes import home_axes
from service.importing.frames import placed
from service.importing.urdf import read_urdf, tips
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


def parts_of(file: Path) -> list[Part]:
    """Return the joints of a reduced file, in its order, without the importer."""

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


@pytest.mark.parametrize("name", LENGTHS)
def test_a_real_arm_has_its_published_lengths_and_moves_as_its_file(name: str) -> None:
    [file] = ARMS.glob(f"{name}-*.urdf")
    [end] = tips(file.read_bytes())
    arm, _ = read_urdf(file.read_bytes(), end)
    made = placed(*home_axes(arm))
    lengths = sorted({abs(round(float(each), 6)) for each in made.table[:, [0, 2]].flat} - {0.0})
    assert lengths == pytest.approx(LENGTHS[name], abs=1e-5)
    turns = made.table[:, 1] / (np.pi / 2)
    assert turns == pytest.approx(np.round(turns), abs=1e-9)
    rng = np.random.default_rng(1)
    for _ in range(10):
        values = rng.uniform(-np.pi, np.pi, len(arm.structure))
        place, turn = tip(parts_of(file), list(values))
        reached = by_table(arm, made, values)
        assert reached[:3, 3] == pytest.approx(place, abs=1e-4)
        for axis in np.eye(3):
            assert reached[:3, :3] @ axis == pytest.approx(turned(turn, list(axis)), abs=1e-4)
