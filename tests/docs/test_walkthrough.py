"""Run the commands of the docs pages from top to bottom."""

from pathlib import Path

import pytest

from tests.docs.walkthrough import Reader, blocks, matches

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.long
@pytest.mark.parametrize(
    ("page", "commands"),
    [
        ("write-an-exercise.md", 10),
        ("marks.md", 1),
        ("formats.md", 12),
        ("assignments.md", 3),
        ("grade-a-folder.md", 1),
        ("collect-homework.md", 2),
        ("ci/README.md", 3),
        ("figures.md", 2),
        ("courses.md", 14),
        ("lti.md", 2),
        ("variants.md", 4),
    ],
)
def test_the_commands_of_a_page_print_the_shown_output(
    page: str, commands: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", "attempts.db")
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 2)
    reader = Reader(tmp_path, monkeypatch)
    reader.follow((DOCS / page).read_text(encoding="utf-8"))
    assert reader.commands >= commands


PAGE = """
```toml arm.toml
a = 1
```
```console exit=2
$ dh-grader exercises check --help
…
$ dh-grader exercises check arm.toml
{printed}
```
"""


def follow(page: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "arm.toml").unlink(missing_ok=True)
    Reader(folder, monkeypatch).follow(page)


def test_a_right_page_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = PAGE.format(printed="…\narm.toml: a (line 1): …there is no key…")
    follow(page, tmp_path, monkeypatch)


@pytest.mark.parametrize(
    ("page", "reason"),
    [
        (PAGE.format(printed=""), "line 5: dh-grader exercises check arm.toml printed"),
        (PAGE.format(printed="arm.toml: fine"), "line 5: dh-grader exercises check arm.toml"),
        (PAGE.format(printed="…\narm.toml: a (line 2): …"), "line 5: dh-grader exercises check"),
        (PAGE.replace(" exit=2", "").format(printed="…"), "exit 2"),
        ("```console\n$ rm arm.toml\n```\n", "rm is not run here"),
        ("```console\n```\n", "no command"),
        ('```csv "a b.csv"\nx\n```\n```csv "a b.csv" expected\ny\n```\n', "line 4: there is\nx"),
    ],
)
def test_a_wrong_page_fails(
    page: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(AssertionError, match=reason):
        follow(page, tmp_path, monkeypatch)


@pytest.mark.parametrize("page", ["```json\n{a: 1}\n```\n", "```toml\na = \n```\n"])
def test_invalid_json_and_toml_fail(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(ValueError, match=r"Expecting|Invalid"):
        follow(page, tmp_path, monkeypatch)


def test_a_block_may_replace_the_one_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ("x.toml\na = 1", "x.toml\nb = 2", "x.toml instead\nc = 3")
    page = "".join(f"```toml {word}\n```\n" for word in words)
    Reader(tmp_path, monkeypatch).follow(page)
    assert (tmp_path / "x.toml").read_text(encoding="utf-8").split() == list("a=1c=3")
    assert [block.line for block in blocks(page)] == [1, 4, 7]


@pytest.mark.parametrize(
    ("expected", "printed", "does"),
    [
        ("a\nb", "a\nb\n", True),
        ("a", "a\nb\n", False),
        ("a\n…", "a\nb\nc\n", True),
        ("…\nc", "a\nb\nc\n", True),
        ("a … c", "a b c\n", True),
        ("a … c", "a b\nc\n", False),
        ("", "", True),
        ("", "a\n", False),
        ("a.c", "abc\n", False),
    ],
)
def test_an_ellipsis_matches_any_text(expected: str, printed: str, does: bool) -> None:
    assert matches(expected, printed) is does
