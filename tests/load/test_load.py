"""A short sample of `make load`."""

import sys
from pathlib import Path

import pytest

from tests.attempts.databases import new_file
from tests.load.__main__ import MIXED, misrecorded
from tests.load.clients import submitted
from tests.server.raw import service

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="loopback has one address there")

CLIENTS = 20


@pytest.mark.campaign
def test_many_clients_at_once_are_all_answered_and_recorded_once(tmp_path: Path) -> None:
    url = new_file(tmp_path)
    with service(tmp_path, DH_GRADER_DATABASE=url) as running:
        told = submitted([running.port], CLIENTS, 1.0, MIXED, "sample")
        assert running.end() == 0
    assert told.failures == []
    assert (told.lost_connections, told.refused) == (0, 0)
    assert len(told.attempts) >= CLIENTS / 4
    assert misrecorded(url, told.attempts) == []
