"""The number and the lifetime of exercise drafts are limited."""

from itertools import count
from pathlib import Path

import pytest
from dh_grader.catalogue import CatalogueError, shipped_folder
from dh_grader.catalogue.load import KEPT, MOST_DRAFTS, Drafts

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
