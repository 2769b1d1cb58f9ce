"""Run a small part of `make attack`."""

import re
from collections.abc import Callable
from contextlib import closing

import pytest

from tests.attack.__main__ import LONGER, attack
from tests.attack.floods import KINDS, of_kind
from tests.attack.in_process import InProcess, Post

GUARD = 6 * LONGER


@pytest.mark.long
def test_honest_clients_are_served_while_others_send_half_heads() -> None:
    broken = attack(0.3, 0.02, "half heads")
    # Waiting times are not checked here, because they depend on the machine.
    assert [line for line in broken if "no answer" in line or "memory" in line] == []


@pytest.mark.long
@pytest.mark.parametrize("source", ["one address", "16 addresses"])
def test_brackets_do_not_delay_honest_clients(
    source: str, capsys: pytest.CaptureFixture[str], figure: Callable[[str], None]
) -> None:
    # One short run instead of five long ones, and a wide margin because of the machine: without
    # turns, the waiting times are 200 times as long.
    broken = attack(3.0, 0.02, f"brackets, {source}, honest clients without", runs=1)
    [ratio] = re.findall(r"p99: ([\d.]+) times", capsys.readouterr().out)
    figure(f"beside brackets from {source}, honest p99 is {ratio} times as long")
    assert [line for line in broken if "no answer" in line or "memory" in line] == []
    assert float(ratio) < GUARD


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", KINDS)
def test_each_costly_body_is_accepted(kind: str) -> None:
    # A refused body would cost nothing.
    body = of_kind(kind)(5).partition(b"\r\n\r\n")[2]
    with closing(InProcess()) as service:
        assert service.post(Post(KINDS[kind][0], body)).status == 200
