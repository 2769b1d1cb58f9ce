"""A class hands in over HTTP while processes of the service are killed."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.courses.hand_ins.kills import killed
from tests.courses.hand_ins.last_minute import last_minute
from tests.guards import ANSWER
from tests.store.databases import KINDS

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs many loopback addresses")

Figure = Callable[[str], None]


@pytest.fixture(params=KINDS)
def database(request: pytest.FixtureRequest) -> tuple[str, str]:
    is_sqlite = request.param == "sqlite"
    folder: Path = request.getfixturevalue("tmp_path")
    url = str(folder / "attempts.db") if is_sqlite else request.getfixturevalue("postgresql_url")
    return request.param, url


SQLITE = pytest.mark.parametrize("database", ["sqlite"], indirect=True)
POSTGRESQL = pytest.mark.parametrize("database", ["postgresql"], indirect=True)


@pytest.mark.long
@SQLITE
def test_hand_ins_of_a_class_at_once_are_in_time_and_recorded_once(
    database: tuple[str, str], tmp_path: Path
) -> None:
    kind, url = database
    outcome, broken = last_minute(url, tmp_path, kind, 15, ["planar-rrr"], 0.5, ANSWER)
    assert broken == []
    assert len(outcome.attempts) == 15


@pytest.mark.long
@POSTGRESQL
def test_a_confirmed_hand_in_survives_a_kill_and_the_limit_holds(
    database: tuple[str, str], tmp_path: Path
) -> None:
    kind, url = database
    _, broken = killed(url, tmp_path, kind, 1)
    assert broken == []


@pytest.mark.campaign
def test_confirmed_hand_ins_survive_twenty_kills(
    database: tuple[str, str], tmp_path: Path, figure: Figure
) -> None:
    kind, url = database
    outcome, broken = killed(url, tmp_path, kind, 20)
    confirmed, lost = len(outcome.attempts), outcome.lost_connections
    figure(f"20 kills on {kind}: {confirmed} hand-ins confirmed, {lost} connections lost")
    assert broken == []
