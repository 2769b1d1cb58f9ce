"""Test how the files of a catalogue are loaded, again when they change, and as drafts."""

import logging
import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import count
from pathlib import Path

import pytest
from dh_grader.catalogue import (
    CatalogueError,
    Exercise,
    exercise_files,
    load_catalogue,
    open_catalogue,
    shipped_folder,
)
from dh_grader.catalogue.load import (
    KEPT,
    MOST_DRAFTS,
    Drafts,
    LateCatalogue,
    LiveCatalogue,
    exercise_in,
)

from tests.catalogue.test_faults import VALID

# --- A catalogue with ``reload`` reads changed files again


class Clock:
    """A clock that the test sets."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write(tmp_path, "arm", VALID)
    return tmp_path


@pytest.fixture
def _logged(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    with caplog.at_level(logging.INFO):
        yield


# Each write gets its own time, even if the disk's clock is coarse.
_times = iter(range(1_700_000_000, 1_800_000_000))


def write(folder: Path, name: str, text: str) -> None:
    file = folder / f"{name}.toml"
    file.write_text(text, encoding="utf-8")
    time = next(_times)
    os.utime(file, (time, time))


def titled(title: str) -> str:
    return VALID.replace("An arm", title)


@pytest.mark.usefixtures("_logged")
def test_a_change_takes_effect_after_a_second(folder: Path, clock: Clock) -> None:
    catalogue = LiveCatalogue([folder], clock)
    version = catalogue["arm"].version
    write(folder, "arm", titled("A new arm"))
    clock.now = 0.9
    assert catalogue["arm"].version == version
    clock.now = 1.1
    assert catalogue["arm"].title == "A new arm"
    assert catalogue["arm"].version != version


@pytest.mark.usefixtures("_logged")
def test_unchanged_files_are_not_read_again(folder: Path, clock: Clock) -> None:
    write(folder, "other", VALID)
    catalogue = LiveCatalogue([folder], clock)
    before = catalogue["other"]
    write(folder, "arm", titled("B"))
    clock.now = 2
    assert catalogue["arm"].title == "B"
    assert catalogue["other"] is before


@pytest.mark.usefixtures("_logged")
def test_files_may_be_added_and_removed(folder: Path, clock: Clock) -> None:
    catalogue = LiveCatalogue([folder], clock)
    write(folder, "boom", VALID)
    clock.now = 2
    assert list(catalogue) == ["arm", "boom"]
    assert [exercise.id for exercise in catalogue.values()] == ["arm", "boom"]
    assert [name for name, _ in catalogue.items()] == ["arm", "boom"]
    (folder / "arm.toml").unlink()
    clock.now = 4
    assert list(catalogue) == ["boom"]
    assert len(catalogue) == 1


@pytest.mark.usefixtures("_logged")
def test_a_broken_file_keeps_its_last_good_version(
    folder: Path, clock: Clock, caplog: pytest.LogCaptureFixture
) -> None:
    catalogue = LiveCatalogue([folder], clock)
    good = catalogue["arm"]
    write(folder, "arm", VALID.replace("points = 4", "points = 0"))
    for clock.now in (2, 4, 6):
        assert catalogue["arm"] is good
    assert caplog.text.count("its last good version stays") == 1
    assert "parts[1].points (line 28): is 0; write a number greater than 0" in caplog.text
    write(folder, "arm", titled("Fixed"))
    clock.now = 8
    assert catalogue["arm"].title == "Fixed"


@pytest.mark.usefixtures("_logged")
def test_a_new_file_that_is_broken_is_left_out(
    folder: Path, clock: Clock, caplog: pytest.LogCaptureFixture
) -> None:
    catalogue = LiveCatalogue([folder], clock)
    write(folder, "half", VALID[:200])
    clock.now = 2
    assert list(catalogue) == ["arm"]
    assert "half.toml cannot be used, so it is left out" in caplog.text


@pytest.mark.usefixtures("_logged")
@pytest.mark.parametrize("text", ["x = " + "[" * 5000, "x = " + "1" * 5000, "\x00", "[" * 100])
def test_any_broken_content_keeps_the_last_good_version(
    text: str, folder: Path, clock: Clock
) -> None:
    catalogue = LiveCatalogue([folder], clock)
    write(folder, "arm", text)
    clock.now = 2
    assert catalogue["arm"].title == "An arm"


@pytest.mark.usefixtures("_logged")
def test_a_missing_folder_keeps_the_exercises(
    folder: Path, clock: Clock, caplog: pytest.LogCaptureFixture
) -> None:
    catalogue = LiveCatalogue([folder], clock)
    (folder / "arm.toml").unlink()
    folder.rmdir()
    for clock.now in (2, 4):
        assert list(catalogue) == ["arm"]
    assert caplog.text.count("The exercises stay as they were") == 1
    folder.mkdir()
    write(folder, "arm", titled("Back"))
    clock.now = 6
    assert catalogue["arm"].title == "Back"


@pytest.mark.usefixtures("_logged")
def test_the_first_of_two_folders_takes_precedence(
    folder: Path, tmp_path_factory: pytest.TempPathFactory, clock: Clock
) -> None:
    other = tmp_path_factory.mktemp("other")
    write(other, "boom", VALID)
    assert list(load_catalogue(other, folder)) == ["boom", "arm"]
    catalogue = LiveCatalogue([other, folder], clock)
    write(other, "arm", titled("A second of that name"))
    clock.now = 2
    assert catalogue["arm"].title == "An arm"
    with pytest.raises(CatalogueError, match=r"arm\.toml: has the name of .*arm\.toml; give it"):
        load_catalogue(other, folder)
    assert list(load_catalogue(folder, folder)) == ["arm"]


@pytest.mark.usefixtures("_logged")
def test_a_broken_file_prevents_the_start(folder: Path) -> None:
    write(folder, "arm", "title = ")
    for reload in (True, False):
        with pytest.raises(CatalogueError, match=r"arm\.toml: is not TOML"):
            open_catalogue([folder], reload=reload)


@pytest.mark.usefixtures("_logged")
def test_only_reload_returns_a_live_catalogue(folder: Path) -> None:
    assert isinstance(open_catalogue([folder], reload=True), LiveCatalogue)
    assert isinstance(open_catalogue([folder], reload=False), LateCatalogue)


@pytest.mark.usefixtures("_logged")
def test_the_files_are_checked_once_a_second(
    folder: Path, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    catalogue = LiveCatalogue([folder], clock)
    looks: list[float] = []

    def look(*folders: Path) -> list[Path]:
        looks.append(clock.now)
        return exercise_files(*folders)

    monkeypatch.setattr("dh_grader.catalogue.load.exercise_files", look)
    for clock.now in (0.5, 0.99, 1.0, 1.2, 1.9, 2.0, 2.5):
        assert catalogue["arm"].id == "arm"
    assert looks == [1.0, 2.0]


@pytest.mark.usefixtures("_logged")
def test_a_folder_for_exercises_to_come_may_be_empty(tmp_path: Path) -> None:
    own, other = tmp_path / "own", tmp_path / "other"
    for each in (own, other):
        each.mkdir()
    with pytest.raises(CatalogueError, match="holds no exercise file"):
        exercise_files(own, other)
    (other / "arm.toml").write_text("", encoding="utf-8")
    assert exercise_files(own, other) == [other / "arm.toml"]


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The ids of the exercises that were compiled, in this order."""
    found: list[str] = []

    def compile_and_note(file: Path, content: bytes) -> Exercise:
        found.append(file.stem)
        return exercise_in(file, content)

    monkeypatch.setattr("dh_grader.catalogue.load.exercise_in", compile_and_note)
    return found


@pytest.mark.usefixtures("_logged")
def test_a_checked_exercise_is_compiled_when_it_is_first_used(compiled: list[str]) -> None:
    shipped = shipped_folder()
    at_once = load_catalogue(shipped)
    compiled.clear()
    catalogue = open_catalogue([shipped], reload=False)
    assert len(catalogue) == len(list(shipped.glob("*.toml")))
    assert compiled == []
    assert catalogue["planar-rr"] is catalogue["planar-rr"]
    with pytest.raises(KeyError):
        catalogue["planar"]
    assert compiled == ["planar-rr"]
    assert isinstance(catalogue, LateCatalogue)
    assert len(list(catalogue.compile_one_by_one())) == len(catalogue) - 1
    assert sorted(compiled) == sorted(file.stem for file in shipped.glob("*.toml"))
    assert [(name, each.version) for name, each in catalogue.items()] == [
        (name, each.version) for name, each in at_once.items()
    ]
    assert len(compiled) == len(catalogue)


@pytest.mark.usefixtures("_logged")
def test_every_file_of_an_author_is_checked_at_the_start(
    tmp_path: Path, compiled: list[str]
) -> None:
    text = (shipped_folder() / "planar-rr.toml").read_text(encoding="utf-8")
    write(tmp_path, "planar-rr", text)  # a copy
    write(tmp_path, "rrrp", text)  # the text of another exercise
    write(tmp_path, "arm", VALID)
    catalogue = open_catalogue([tmp_path], reload=False)
    assert compiled == ["arm", "rrrp"]
    # The exercise is that of the start, although the file has changed.
    write(tmp_path, "planar-rr", "title = ")
    assert catalogue["planar-rr"].title == load_catalogue(shipped_folder())["planar-rr"].title
    write(tmp_path, "other", "source = ")
    with pytest.raises(CatalogueError) as error:
        open_catalogue([tmp_path], reload=False)
    assert [(fault.file.stem, fault.reason.partition(":")[0]) for fault in error.value.faults] == [
        ("other", "is not TOML"), ("planar-rr", "is not TOML"),
    ]  # fmt: skip


@pytest.mark.usefixtures("_logged")
def test_threads_that_come_at_once_get_one_exercise() -> None:
    catalogue = open_catalogue([shipped_folder()], reload=False)
    names = [file.stem for file in shipped_folder().glob("*.toml")] * 4
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(catalogue.__getitem__, names))
    assert all(each is catalogue[name] for name, each in zip(names, found, strict=True))


# --- The number and the lifetime of exercise drafts are limited

TEXT = (shipped_folder() / "planar-rr.toml").read_text(encoding="utf-8")


def test_a_draft_is_kept_for_a_limited_time() -> None:
    now = 5.0
    drafts = Drafts(clock=lambda: now)
    name = drafts.put(TEXT)
    now += KEPT - 1
    assert drafts.get(name) is not None
    assert drafts.put(TEXT, name) == name
    now += KEPT - 1
    assert drafts.get(name) is not None
    now += 2
    assert drafts.get(name) is None


def test_the_oldest_drafts_are_dropped() -> None:
    seconds = count()
    drafts = Drafts(clock=lambda: next(seconds))
    names = [drafts.put(TEXT) for _ in range(MOST_DRAFTS + 2)]
    assert [drafts.get(name) is None for name in names[:3]] == [True, True, False]
    # The author cannot choose an id.
    assert drafts.put(TEXT, "scara").startswith("draft-")


def test_processes_share_the_drafts_of_a_folder(tmp_path: Path) -> None:
    now = 5.0
    one, other = (Drafts(tmp_path, lambda: now) for _ in range(2))
    name = one.put(TEXT)
    assert other.get(name) is not None
    now += 1
    assert other.put(TEXT.replace("Planar", "Flat"), name) == name
    for drafts in (one, other):
        found = drafts.get(name)
        assert found is not None
        assert found.title.startswith("Flat")
    with pytest.raises(CatalogueError):
        one.put("title = 1", name)
    assert len(list(tmp_path.iterdir())) == 1


def test_an_id_reaches_no_other_file(tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text(TEXT, encoding="utf-8")
    (tmp_path / "drafts").mkdir()
    drafts = Drafts(tmp_path / "drafts")
    drafts.put(TEXT)
    for hostile in ("../arm", "draft-../arm", "arm", "", "draft-" + "0" * 32, "draft-\0"):
        assert drafts.get(hostile) is None
