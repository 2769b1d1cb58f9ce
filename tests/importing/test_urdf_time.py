"""Hostile URDF files are soon refused, with a reason."""

import time
from collections.abc import Callable

import pytest
from dh_grader.importing.urdf import UnusableUrdfError, read_urdf

from tests.importing.urdf_texts import Part, urdf

# Seconds of processor time: ten times the budget of 100 ms.
GUARD = 1.0
MEBIBYTE = 2**20
ONE = Part("revolute", (0, 0, 0.1), (0, 0, 0))
GOOD = urdf([ONE])


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
