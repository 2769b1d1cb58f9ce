"""A small sample of `make attack`."""

from contextlib import closing

import pytest

from tests.attack.__main__ import attack
from tests.attack.floods import KINDS, of_kind
from tests.attack.in_process import InProcess, Post


def test_honest_clients_are_served_while_others_send_halves() -> None:
    broken = attack(0.3, 0.02, "half heads")
    # How long things took says more about the machine than about the server.
    assert [line for line in broken if "no answer" in line or "memory" in line] == []


@pytest.mark.parametrize("kind", KINDS)
def test_the_service_works_for_each_costly_body(kind: str) -> None:
    """A body that is refused costs nothing."""
    body = of_kind(kind)(5).partition(b"\r\n\r\n")[2]
    with closing(InProcess()) as service:
        assert service.post(Post(KINDS[kind][0], body)).status == 200
