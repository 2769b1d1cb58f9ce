"""A small sample of `make attack`."""

from tests.attack.__main__ import attack


def test_honest_clients_are_served_while_others_send_halves() -> None:
    broken = attack(0.3, 0.02, "half heads")
    # How long things took says more about the machine than about the server.
    assert [line for line in broken if "no answer" in line or "memory" in line] == []
