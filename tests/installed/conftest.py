from pathlib import Path

import pytest

from tests.installed.environment import build, environment, install


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the path of the wheel, built from the checkout."""
    return build(tmp_path_factory.mktemp("dist"))


@pytest.fixture(scope="session")
def programs(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the bin folder of an environment in which the wheel is installed."""
    found = environment(tmp_path_factory.mktemp("installed") / "environment")
    install(wheel, found)
    return found
