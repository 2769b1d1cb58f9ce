"""What every test folder may use: the shipped exercises, and exercises written for one test."""

import gc
import os
import random
import sys
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from service.catalogue import Exercise, load_exercise
from service.catalogue.parts.dh_table import DhTableSpec
from tests.api.serving import Served, served
from tests.shipped import shipped_exercises

pytest_plugins = ["tests.browser.fixtures"]

# The suite starts this program a hundred times: it would be compiled each time.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# How long one example takes says more about the machine than about the code.
for profile, examples in (("suite", 30), ("thorough", 500)):
    settings.register_profile(
        profile,
        deadline=None,
        max_examples=examples,
        suppress_health_check=[HealthCheck.too_slow],
    )
settings.load_profile("suite")

FIGURE = "figure"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """One more than there are cores: many a test waits for a process or a page."""
    return (os.cpu_count() or 1) + 1


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--shuffle", metavar="SEED", help="run the tests in the order of this seed")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Shuffle all tests if asked to; each process does so alike."""
    if seed := config.getoption("shuffle"):
        random.Random(seed).shuffle(items)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """The collector of garbage never looks at the tests themselves, which live to the end."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.fixture
def figure(record_property: Callable[[str, object], None]) -> Callable[[str], None]:
    """Notes a measured figure, to be shown at the end of the run."""
    return lambda line: record_property(FIGURE, line)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Show the figures; they come with the reports of the tests, also from other processes."""
    figures = [
        str(value)
        for reports in terminalreporter.stats.values()
        for report in reports
        if getattr(report, "when", None) == "call"
        for name, value in report.user_properties
        if name == FIGURE
    ]
    if figures:
        terminalreporter.section("figures")
        for line in figures:
            terminalreporter.write_line(line)


@pytest.fixture(scope="session")
def catalogue() -> Mapping[str, Exercise]:
    """The shipped exercises by id."""
    return shipped_exercises()


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A real process with the usual settings, for tests that neither end it nor make it busy."""
    with served(tmp_path_factory.mktemp("server")) as server:
        yield server


@pytest.fixture(scope="session")
def given_frames(catalogue: Mapping[str, Exercise]) -> Mapping[str, Exercise]:
    """Table and pose of the same exercises, the frames prescribed, so that one table is right."""
    given = {"frames": "given", "base": "given", "tool": "given", "directions": "given"}
    return {
        name: replace(
            exercise,
            parts=tuple(
                part.model_copy(update=given | {"follows": None})
                if isinstance(part, DhTableSpec)
                else part.model_copy(update={"follows": None})
                for part in exercise.parts
                if part.id in ("table", "pose")
            ),
        )
        for name, exercise in catalogue.items()
    }


@pytest.fixture
def make_exercise(tmp_path: Path) -> Callable[[str], Exercise]:
    """Compiles the text of an exercise file."""

    def make(text: str) -> Exercise:
        file = tmp_path / "test-exercise.toml"
        file.write_text(text, encoding="utf-8")
        return load_exercise(file)

    return make
