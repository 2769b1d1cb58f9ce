"""Run a small part of `make attack`."""

from contextlib import closing

import pytest

from tests.attack.__main__ import attack
from tests.attack.floods import KINDS, of_kind
from tests.attack.in_process import InProcess, Post


@pytest.mark.long
def test_honest_clients_are_served_while_others_send_half_heads() -> None:
    broken = attack(0.3, 0.02, "half heads")
    # Waiting times are not checked here, because they depend on the machine.
    assert [line for line in broken if "no answer" in line or "memory" in line] == []


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", KINDS)
def test_each_costly_body_is_accepted(kind: str) -> None:
    # A refused body would cost nothing.
    body = of_kind(kind)(5).partition(b"\r\n\r\n")[2]
    with closing(InProcess()) as service:
        assert service.post(Post(KINDS[kind][0], body)).status == 200
