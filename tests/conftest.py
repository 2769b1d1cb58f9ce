"""Fixtures for all tests: exercises, and a server."""

import gc
import os
import random
import sys
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import pytest
import typer.rich_utils
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.catalogue.kinds import DhTableSpec
from hypothesis import HealthCheck, settings

from tests.api.serving import Served, served
from tests.shipped import shipped_exercises

pytest_plugins = ["tests.browser.fixtures", "tests.store.databases"]

# The suite starts this program a hundred times: without bytecode it would be compiled each time.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# The command line speaks the language of the environment, and tests read English. The words of
# typer are those of the moment when its module is loaded.
for _variable in ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "DH_GRADER_LANGUAGE"):
    os.environ.pop(_variable, None)
os.environ["LANG"] = "C.UTF-8"
assert typer.rich_utils.OPTIONS_PANEL_TITLE == "Options"

# No deadline: the time of an example depends more on the machine than on the code.
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
    # Return the number of processes: one more than the cores, because many tests only wait.
    return (os.cpu_count() or 1) + 1


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--shuffle", metavar="SEED", help="run the tests in the order of this seed")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark most cases of large tests as long, and shuffle tests on request."""
    # In a test with the marker `sampled(n)`, every n-th case is in the sample. All processes use
    # the same order of tests.
    places: Counter[str] = Counter()
    for item in items:
        if (sampled := item.get_closest_marker("sampled")) is not None:
            name = item.nodeid.partition("[")[0]
            if places[name] % sampled.args[0]:
                item.add_marker(pytest.mark.long)
            places[name] += 1
    if seed := config.getoption("shuffle"):
        random.Random(seed).shuffle(items)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    # Exclude the collected tests from garbage collection, because they live until the end.
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.fixture
def figure(record_property: Callable[[str, object], None]) -> Callable[[str], None]:
    """Return a function that records a measurement."""
    return lambda line: record_property(FIGURE, line)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print the recorded measurements of all processes."""
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
    """A server process with default settings, which tests share."""
    with served(tmp_path_factory.mktemp("server")) as server:
        yield server


@pytest.fixture(scope="session")
def given_frames(catalogue: Mapping[str, Exercise]) -> Mapping[str, Exercise]:
    """The shipped exercises, reduced to their table and their pose."""
    # All frames are given, so exactly one table is correct.
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
    """A function that compiles the text of an exercise file."""

    def make(text: str) -> Exercise:
        file = tmp_path / "test-exercise.toml"
        file.write_text(text, encoding="utf-8")
        return load_exercise(file)

    return make
