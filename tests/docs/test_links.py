"""Links between pages of docs/ have existing targets."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
_CODE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
_SECTION = re.compile(r"\]\(([^)#\s:]*)#([^)\s]+)\)")


def prose(page: Path) -> str:
    """Return the page without its code blocks."""
    return _CODE.sub("", page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_names_others_by_links(page: Path) -> None:
    assert re.findall(r"`[\w/-]+\.md`", prose(page)) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_link_leads_to_a_file(page: Path) -> None:
    targets = [target for target in _LINK.findall(prose(page)) if "://" not in target]
    assert [target for target in targets if not (page.parent / target).is_file()] == []


def anchors(page: Path) -> set[str]:
    """Return the anchors that GitHub and GitLab derive from a page's headings."""
    headings = re.findall(r"^#+ (.+)$", prose(page), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_link_to_a_section_leads_to_one(page: Path) -> None:
    assert [
        (target, section)
        for target, section in _SECTION.findall(prose(page))
        if section not in anchors(page.parent / target if target else page)
    ] == []


def test_every_page_is_linked_from_another() -> None:
    linked = {
        (page.parent / target).resolve()
        for page in PAGES
        for target in _LINK.findall(prose(page))
        if "://" not in target
    }
    assert set(PAGES) - linked == set()
