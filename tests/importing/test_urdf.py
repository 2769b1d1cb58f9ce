"""Test how URDF files are read, also those of makers."""

import time
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from dh_grader.importing.urdf import (
    Arm,
    Placed,
    UnclearAxesError,
    UnusableUrdfError,
    greatest_difference,
    home_axes,
    placed,
    read_urdf,
    tips,
)
from dh_grader.kinematics import Convention, frames

from tests.importing.urdf_texts import Part, random_parts, tip, turned, urdf

ONE = Part("revolute", [0, 0, 0.1], [0, 0, 0])


def test_tips_are_the_links_without_children() -> None:
    text = urdf([ONE, ONE]).replace(b"</robot>", b'<link name="camera"/></robot>')
    assert tips(text) == ["l2", "camera"]


def test_a_part_of_the_chain_can_be_read() -> None:
    arm, _ = read_urdf(urdf([ONE, ONE, ONE]), "l2", "l1")
    assert (arm.base, arm.tip, arm.structure) == ("l1", "l2", "R")


REFUSED = {
    "doctype": (b'<!DOCTYPE robot [<!ENTITY a "aaaa">]><robot name="&a;"/>', "DOCTYPE"),
    "external": (b'<!DOCTYPE robot SYSTEM "file:///etc/passwd"><robot/>', "DOCTYPE"),
    "million elements": (b"<robot>" + b"<a/>" * 200_000 + b"</robot>", "20000 elements"),
    "too large": (b"<robot>" + b" " * 2**20 + b"</robot>", "larger than 1024 KiB"),
    "deep": (b"<robot>" + b"<a>" * 100_000, "too deep"),
    "many links": (b"<robot>" + b'<link name="l"/>' * 201 + b"</robot>", "200 links"),
    "not a robot": (b"<sdf/>", "not with <robot>"),
    "open": (b"<robot>", "not well-formed"),
    "empty": (b"", "not well-formed"),
    "no XML": (b"\x00\xff\x13", "not well-formed"),
    "encoding": (b'<?xml version="1.0" encoding="foo"?><robot/>', "encoding"),
    "xacro": (b'<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arm/></robot>', "xacro"),
    "xacro without namespace": (b"<robot><xacro:arm/></robot>", "xacro"),
    "xacro property": (
        urdf([ONE]).replace(b"</robot>", b'<xacro:property name="a" value="${b}"/></robot>'),
        "xacro",
    ),
    "xacro value": (urdf([ONE]).replace(b"0.100000000", b"${h}"), "xacro"),
    "loop": (
        urdf([ONE, ONE]).replace(b"</robot>", b'<joint name="x" type="fixed"><parent link="l2"/>'
                                 b'<child link="l0"/></joint></robot>'),
        "closed loop",
    ),
    "two parents": (
        urdf([ONE, ONE]).replace(b"</robot>", b'<joint name="x" type="fixed"><parent link="l0"/>'
                                 b'<child link="l2"/></joint></robot>'),
        "closed loop",
    ),
    "nan": (urdf([ONE]).replace(b"0.100000000", b"nan"), "three numbers"),
    "infinite": (urdf([ONE]).replace(b"0.100000000", b"1e400"), "three numbers"),
    "huge": (urdf([ONE]).replace(b"0.100000000", b"1e99"), "over a million"),
    "two numbers": (urdf([ONE]).replace(b"0.100000000", b""), "three numbers"),
    "no axis": (urdf([Part("revolute", [0, 0, 0], [0, 0, 0], [0, 0, 0])]), "no direction"),
    "planar": (urdf([Part("planar", [0, 0, 0], [0, 0, 0])]), "of type 'planar'"),
    "no joints": (urdf([Part("fixed", [0, 0, 0], [0, 0, 0])]), "0 moving joints"),
    "eleven joints": (urdf([ONE] * 11), "11 moving joints"),
    "mimic": (urdf([ONE]).replace(b"</joint>", b'<mimic joint="other"/></joint>'), "mimic"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_an_unusable_file_is_refused_with_its_reason(name: str) -> None:
    text, reason = REFUSED[name]
    joints = text.count(b'name="j')
    tip = f"l{joints}" if joints else "tool"
    began = time.process_time()
    with pytest.raises(UnusableUrdfError, match=reason):
        read_urdf(text, tip)
    assert time.process_time() - began < 1


def test_an_unused_xacro_property_is_no_template() -> None:
    unused = b'<xacro:property name="pi" value="3.14159"/></robot>'
    arm, _ = read_urdf(urdf([ONE]).replace(b"</robot>", unused), "l1")
    assert arm.structure == "R"


def test_an_undeclared_prefix_does_not_matter() -> None:
    text = urdf([ONE]).replace(b"</joint>", b'<limit drake:acceleration="2.5"/></joint>')
    arm, _ = read_urdf(text, "l1")
    assert arm.structure == "R"


def test_unknown_links_are_named() -> None:
    with pytest.raises(UnusableUrdfError, match="no link 'tool9'; its tree ends at: l1"):
        read_urdf(urdf([ONE]), "tool9")
    with pytest.raises(UnusableUrdfError, match="not on the way"):
        read_urdf(urdf([ONE, ONE]), "l1", "l2")


# --- Hostile URDF files are soon refused, with a reason

# Seconds of processor time: ten times the budget of 100 ms.
GUARD = 1.0
MEBIBYTE = 2**20
URDF_TIME_ONE = Part("revolute", (0, 0, 0.1), (0, 0, 0))
GOOD = urdf([URDF_TIME_ONE])


def filled(head: bytes, unit: bytes, end: bytes = b"</robot>") -> bytes:
    return head + unit * ((MEBIBYTE - len(head) - len(end)) // len(unit)) + end


def entities() -> bytes:
    """Return a URDF file whose entities would expand to 10^9 letters."""
    levels = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 10))
    return f'<!DOCTYPE robot [<!ENTITY e0 "a">{levels}]><robot name="&e9;"/>'.encode()


def ring() -> bytes:
    links = "".join(f'<link name="l{i}"/>' for i in range(199))
    joints = "".join(
        f'<joint name="j{i}" type="fixed"><parent link="l{i}"/><child link="l{(i + 1) % 199}"/>'
        "</joint>"
        for i in range(199)
    )
    return f'<robot name="ring">{links}{joints}</robot>'.encode()


HOSTILE: dict[str, tuple[Callable[[], bytes], str]] = {
    "entities": (entities, "DOCTYPE"),
    "a million nodes": (lambda: b"<robot>" + b"<a/>" * 10**6 + b"</robot>", "larger than"),
    "most nodes in a file": (lambda: filled(b"<robot>", b"<a/>"), "elements"),
    "deep nodes": (lambda: filled(b"<robot>", b"<a>", b""), "too deep"),
    "many joints": (lambda: filled(b"<robot>", b"<joint/>"), "elements"),
    "many links": (lambda: filled(b"<robot>", b"<link/>"), "200 links"),
    "long comment": (lambda: filled(b"<robot><!--", b"a", b"--></robot>"), "no link"),
    "many attributes": (
        lambda: b"<robot " + b" ".join(b'a%d=""' % i for i in range(80_000)) + b"/>",
        "no link",
    ),
    "long name": (lambda: filled(b'<robot><link name="', b"a", b'"/></robot>'), "no link"),
    "ring": (ring, "closed loop"),
    "nan": (lambda: GOOD.replace(b"0.100000000", b"nan"), "three numbers"),
    "long number": (lambda: GOOD.replace(b"0.100000000", b"1" * 10**6), "three numbers"),
    "number after spaces": (
        lambda: GOOD.replace(b"0.100000000", b"0.1" + b" " * 10**5 + b"7"),
        "three numbers",
    ),
    "xacro": (lambda: filled(b"<robot>", b"<xacro:arm/>"), "xacro"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused_soon(name: str) -> None:
    make, reason = HOSTILE[name]
    data = make()
    start = time.process_time()
    with pytest.raises(UnusableUrdfError, match=reason):
        read_urdf(data, "l1")
    assert time.process_time() - start < GUARD


# --- Frames


def imported(parts: list[Part], decimals: int = 9) -> tuple[Arm, Placed]:
    arm, _ = read_urdf(urdf(parts, decimals), f"l{len(parts)}")
    return arm, placed(*home_axes(arm))


def by_table(arm: Arm, made: Placed, values: np.ndarray) -> np.ndarray:
    table = made.table.copy()
    for i, letter in enumerate(arm.structure):
        table[i, 2 if letter == "P" else 3] += values[i]
    return np.asarray(made.base @ frames(table, Convention.STANDARD)[-1] @ made.tool)


@pytest.mark.parametrize("crooked", [False, True])
@pytest.mark.parametrize("seed", range(40))
def test_the_table_moves_the_tip_as_the_urdf_does(seed: int, crooked: bool) -> None:
    rng = np.random.default_rng([seed, crooked])
    parts = random_parts(rng, crooked=crooked)
    try:
        arm, made = imported(parts)
    except UnclearAxesError:
        pytest.skip("axes nearly parallel")
    values = rng.uniform(-2, 2, len(arm.structure))
    place, turn = tip(parts, list(values))
    reached = by_table(arm, made, values)
    # Lengths are rounded to 0.01 mm.
    assert reached[:3, 3] == pytest.approx(place, abs=2e-4)
    for axis in np.eye(3):
        assert reached[:3, :3] @ axis == pytest.approx(turned(turn, list(axis)), abs=1e-4)


@pytest.mark.parametrize("seed", range(20))
def test_angles_of_right_angled_arms_are_multiples_of_90_degrees_however_rounded(seed: int) -> None:
    rng = np.random.default_rng(seed)
    parts = random_parts(rng, crooked=False)
    for decimals in (4, 6, 15):
        _, made = imported(parts, decimals)
        turns = made.table[:, [1]] / (np.pi / 2)
        assert turns == pytest.approx(np.round(turns), abs=1e-9)
        assert np.abs(made.table[:, [0, 2]]).max() < 10


def test_parallel_axes_that_a_maker_rounded_have_no_far_common_normal() -> None:
    parts = [
        Part("revolute", [0, 0, 0.1], [1.5708, 0, 0]),
        Part("revolute", [0.4, 0, 0], [0, 0, 0]),
        Part("revolute", [0.3, 0, 0.1], [-1.5708, 3.1416, 1.57]),
    ]
    _, made = imported(parts, 4)
    assert made.table[0] == pytest.approx([0.4, 0, 0, 0], abs=1e-9)


def test_axes_that_are_nearly_parallel_are_refused() -> None:
    parts = [Part("revolute", [0, 0, 0], [0, 0, 0]), Part("revolute", [0.4, 0, 0], [0.0012, 0, 0])]
    with pytest.raises(UnclearAxesError, match="joints 1 and 2 are nearly parallel"):
        imported(parts)


def test_the_difference_is_that_of_the_worst_pose() -> None:
    parts = [Part("revolute", [0, 0, 0], [0, 0, 0]), Part("fixed", [0.5, 0, 0], [0, 0, 0])]
    arm, made = imported(parts)
    longer = [parts[0], Part("fixed", [0.502, 0, 0], [0, 0, 0])]
    exact, _ = read_urdf(urdf(longer), "l2")
    length, angle = greatest_difference(made, arm.structure, exact.pose)
    assert length == pytest.approx(0.002)
    assert angle == pytest.approx(0, abs=1e-12)


# --- Import the URDF files of real arms as tables

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
