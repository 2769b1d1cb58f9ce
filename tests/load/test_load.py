"""Run a short part of `make load`."""

import sys
from pathlib import Path

import pytest

from tests.load.__main__ import MIXED, misrecorded
from tests.load.clients import submitted
from tests.server.raw import service
from tests.store.databases import new_file

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs many loopback addresses")

CLIENTS = 20


@pytest.mark.campaign
def test_attempts_of_many_clients_are_answered_and_recorded_once(tmp_path: Path) -> None:
    url = new_file(tmp_path)
    with service(tmp_path, DH_GRADER_DATABASE=url) as running:
        results = submitted([running.port], CLIENTS, 1.0, MIXED, "sample")
        assert running.end() == 0
    assert results.failures == []
    assert (results.lost_connections, results.refused) == (0, 0)
    assert len(results.attempts) >= CLIENTS / 4
    assert misrecorded(url, results.attempts) == []
