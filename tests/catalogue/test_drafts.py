"""Drafts: a few, for a limited time."""

from service.catalogue import shipped_folder
from service.catalogue.drafts import KEPT, MOST_DRAFTS, Drafts

TEXT = (shipped_folder() / "planar-rr.toml").read_text(encoding="utf-8")


def test_a_draft_is_kept_for_a_limited_time() -> None:
    now = 5.0
    drafts = Drafts(lambda: now)
    name = drafts.put(TEXT)
    now += KEPT - 1
    assert drafts.get(name) is not None
    assert drafts.put(TEXT, name) == name
    now += KEPT - 1
    assert drafts.get(name) is not None
    now += 2
    assert drafts.get(name) is None


def test_the_oldest_drafts_are_dropped() -> None:
    drafts = Drafts()
    names = [drafts.put(TEXT) for _ in range(MOST_DRAFTS + 2)]
    assert [drafts.get(name) is None for name in names[:3]] == [True, True, False]
    # The author cannot choose an id.
    assert drafts.put(TEXT, "scara").startswith("draft-")
