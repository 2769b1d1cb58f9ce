"""A command writes its whole output folder, or nothing."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from dh_grader.cli.grade import UnusableFolderError, is_for_folder, write_folder
from dh_grader.formats.class_page import WRITTEN
from dh_grader.formats.graded import Document

NEEDS_LINKS = pytest.mark.skipif(os.name == "nt", reason="needs symbolic links")


def documents(*names: str, end: BaseException | None = None) -> Iterator[Document]:
    for name in names:
        yield Document(f"reports/{name}.html", [b"page of ", name.encode()])
    if end is not None:
        raise end
    yield Document("index.html", [b" ".join(name.encode() for name in names)])


def content(folder: Path) -> dict[str, str]:
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != WRITTEN)
    return {path.relative_to(folder).as_posix(): path.read_text() for path in files}


TWO = {"reports/a.html": "page of a", "reports/b.html": "page of b", "index.html": "a b"}


def test_a_new_folder_is_created_with_all_documents(tmp_path: Path) -> None:
    write_folder(documents("a", "b"), tmp_path / "class")
    assert content(tmp_path) == {f"class/{name}": text for name, text in TWO.items()}


def test_an_empty_folder_or_one_of_an_earlier_run_is_replaced(tmp_path: Path) -> None:
    for names in (("x", "y", "z"), ("a", "b")):
        write_folder(documents(*names), tmp_path)
    assert content(tmp_path) == TWO
    assert sorted(path.name for path in tmp_path.iterdir()) == [WRITTEN, "index.html", "reports"]


@pytest.mark.parametrize("end", [KeyboardInterrupt(), OSError(28, "No space left on device")])
@pytest.mark.parametrize("before", [(), ("a", "b")])
def test_an_interrupted_run_leaves_no_incomplete_folder(
    tmp_path: Path, before: tuple[str, ...], end: BaseException
) -> None:
    folder = tmp_path / "class"
    if before:
        write_folder(documents(*before), folder)
    with pytest.raises((KeyboardInterrupt, UnusableFolderError)):
        write_folder(documents("c", "d", end=end), folder)
    assert content(tmp_path) == {f"class/{name}": text for name, text in TWO.items() if before}
    assert folder.exists() is bool(before)


def test_a_failed_replacement_restores_the_old_content(tmp_path: Path) -> None:
    write_folder(documents("a", "b"), tmp_path)

    def with_somebody_else() -> Iterator[Document]:
        yield from documents("c")
        # Meanwhile another program writes to the folder, so that a name is taken.
        (tmp_path / "reports" / "late.html").write_text("late")
        (tmp_path / "last" / "x").mkdir(parents=True)
        yield Document("last", [b"a file"])

    with pytest.raises(UnusableFolderError, match="cannot be written"):
        write_folder(with_somebody_else(), tmp_path)
    assert content(tmp_path) == {**TWO, "reports/late.html": "late"}


@pytest.mark.parametrize("strange", ["notes.txt", "reports/notes.txt", "other/", "reports/deep/"])
def test_a_folder_with_foreign_content_is_refused(tmp_path: Path, strange: str) -> None:
    write_folder(documents("a", "b"), tmp_path)
    if strange.endswith("/"):
        (tmp_path / strange).mkdir()
    else:
        (tmp_path / strange).write_text("mine")
    with pytest.raises(UnusableFolderError, match="which no earlier run has written"):
        write_folder(documents("c"), tmp_path)
    assert content(tmp_path).items() >= TWO.items()
    assert (tmp_path / strange).exists()


def test_foreign_pages_are_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("my home page")
    with pytest.raises(UnusableFolderError, match=r"index\.html"):
        write_folder(documents("a"), tmp_path)
    assert content(tmp_path) == {"index.html": "my home page"}


@NEEDS_LINKS
def test_links_are_not_followed(tmp_path: Path) -> None:
    folder, elsewhere = tmp_path / "class", tmp_path / "elsewhere"
    write_folder(documents("a"), folder)
    elsewhere.mkdir()
    (elsewhere / "a.html").write_text("mine")
    (folder / "reports" / "a.html").unlink()
    (folder / "reports" / "a.html").symlink_to(elsewhere / "a.html")
    with pytest.raises(UnusableFolderError):
        write_folder(documents("b"), folder)
    assert content(elsewhere) == {"a.html": "mine"}


@pytest.mark.parametrize("path", ["../x.html", "/x.html", "a/../../x.html", "a/b/c.html", "a\nb"])
def test_no_path_leads_out_of_the_folder(tmp_path: Path, path: str) -> None:
    with pytest.raises(ValueError, match="does not stay in its folder"):
        write_folder([Document(path, [b"x"])], tmp_path / "class")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_whose_parent_is_missing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UnusableFolderError, match="cannot be written: No such file"):
        write_folder(documents("a"), tmp_path / "no" / "class")


def test_a_new_output_without_suffix_is_a_folder_for_several_submissions(
    tmp_path: Path,
) -> None:
    file = tmp_path / "file"
    file.touch()
    assert is_for_folder(tmp_path, several=False)
    assert is_for_folder(tmp_path / "new", several=True)
    assert not is_for_folder(tmp_path / "new", several=False)
    assert not is_for_folder(tmp_path / "new.HTML", several=True)
    assert not is_for_folder(file, several=True)
