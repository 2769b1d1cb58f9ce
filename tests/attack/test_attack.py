"""Run small attacks."""

import re
from collections.abc import Callable
from contextlib import closing
from itertools import islice
from pathlib import Path

import pytest

from tests.attack.__main__ import LONGER, attack
from tests.attack.floods import KINDS, of_kind
from tests.attack.hostile import Case, Found, Reading, group, groups, sample
from tests.attack.in_process import InProcess, Post
from tests.attack.interface import SECRET, faults, with_key
from tests.attack.memory import measured, posts, resident
from tests.attack.misreadings import REFUSED, SECTIONS, Tally, tallied
from tests.server.raw import service

# --- Run a small part of `make attack`

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


# --- Run a small part of `make fuzz`


@pytest.mark.long
def test_hostile_texts_grids_and_requests() -> None:
    found = sample(250, "hostile")
    assert found.escaped == []
    assert found.differing == []
    kinds = {name.split()[0] for name in found.outcomes}
    assert kinds == {"text", "grid", "submission", "preview"}


class Unsteady(Reading):
    """A fake reader that gives a different result each time."""

    def __init__(self) -> None:
        self.times = 0

    def outcome(self, case: Case) -> tuple[str, bytes, float]:
        self.times += 1
        if case.value == "bad":
            raise ValueError(case.value)
        return "text read", str(self.times).encode(), 0.0


def test_exceptions_and_differing_readings_are_found() -> None:
    found = group([Case("text", "q1"), Case("text", "bad")], Unsteady())
    assert [line.split()[0] for line in found.differing] == ["twice", "from"]
    assert len(found.escaped) == 1
    total = Found()
    total.add(found)
    assert (total.count, total.outcomes["text read"]) == (2, 1)


def test_the_sizes_of_the_groups_sum_up_to_the_count() -> None:
    assert list(groups(1200, "a", 500)) == [(500, "a.0"), (500, "a.1"), (200, "a.2")]


# --- Run a small part of the generated requests of `make attack`


@pytest.mark.long
@pytest.mark.parametrize("keyed", [False, pytest.param(True, marks=pytest.mark.campaign)])
def test_the_service_follows_its_openapi_document(tmp_path: Path, keyed: bool) -> None:
    phases = "examples,fuzzing" if keyed else "examples"
    sample = ["--phases", phases, "--no-shrink", "--generation-database", "none"]
    settings, key = with_key(tmp_path) if keyed else ({}, "")
    with service(tmp_path, **settings) as running:
        assert list(faults(running, tmp_path, 2, "--seed", "1", *sample, key=key)) == []
    log = (tmp_path / "log").read_text(encoding="utf-8")
    assert ("/v1/attempts" if keyed else "/v1/exercises") in log
    assert not any(secret in log for secret in (key or "dhg_", SECRET))


# --- Run a small part of `python -m tests.attack.memory`


def test_no_two_requests_are_the_same() -> None:
    assert len(set(islice(posts("suite"), 400))) == 400


def test_a_few_requests_need_little_memory() -> None:
    found = measured(40, 20, "suite")
    assert found.failures == 0
    # The caches are not yet full after so few.
    assert not found.growth > 50


def test_the_measured_memory_grows_with_allocations() -> None:
    before = resident()
    if before != before:
        pytest.skip("this system does not say")
    kept = bytearray(b"x" * 30_000_000)
    assert resident() - before > 20
    assert kept


# --- Run a small part of `python -m tests.attack.misreadings`


@pytest.mark.long
@pytest.mark.parametrize(
    ("section", "count"), [("spellings", 30), ("grids", 3), ("submissions", 4)]
)
def test_no_formula_is_read_as_another_one(section: str, count: int) -> None:
    tally = tallied(section, count, "suite")
    assert tally.misread == []
    refused = {name: tally.refused(name) for name in tally.outcomes}
    # Of a few texts, a single refusal is a large share.
    assert {name: share for name, share in refused.items() if share > REFUSED + 1 / count} == {}


def test_a_tally_counts_readings_refusals_and_misreadings() -> None:
    tally = Tally()
    tally.add("plain", "read")
    tally.add("plain", "refused: two_values")
    tally.add("plain", "misread", "c12")
    assert tally.refused("plain") == pytest.approx(2 / 3)
    assert tally.misread == ["plain: c12"]
    assert list(SECTIONS) == ["spellings", "grids", "submissions"]
