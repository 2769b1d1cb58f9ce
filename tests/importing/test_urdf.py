import time

import pytest
from dh_grader.importing.urdf import UnusableUrdfError, read_urdf, tips

from tests.importing.urdf_texts import Part, urdf

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
