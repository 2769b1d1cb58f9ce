"""The program finds the students and their files in the folders of a course."""

import io
import os
import sys
import zipfile
from pathlib import Path

import pytest

from service.submissions import handed_in
from service.submissions.handed_in import HandedIn, all_handed_in
from service.submissions.office_files import UnusableFileError

needs_links = pytest.mark.skipif(os.name == "nt", reason="needs a right for symbolic links")


def save(folder: Path, *names: str) -> None:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("{}", encoding="utf-8")


def told(found: HandedIn) -> tuple[str, list[str]]:
    return found.learner, [file.name for file in found.files()]


def students(folder: Path) -> list[tuple[str, list[str]]]:
    return [told(each) for each in all_handed_in([folder])]


def test_each_file_and_each_folder_is_one_student(tmp_path: Path) -> None:
    save(tmp_path, "carl.b/scara/table.csv", "carl.b/answer.json", "bert.json", "anna.json")
    assert students(tmp_path) == [
        ("anna", ["anna.json"]),
        ("bert", ["bert.json"]),
        ("carl.b", ["answer.json", "scara/table.csv"]),
    ]


def test_files_named_after_a_student_and_a_part_belong_together(tmp_path: Path) -> None:
    save(tmp_path, "ben.table.csv", "ada.m.pose.csv", "ada.m.table-1.m", "ada.csv", "c.table/x.csv")
    found = list(all_handed_in([tmp_path], parts={"table", "pose"}))
    assert [told(each) for each in found] == [
        ("ada", ["ada.csv"]),
        ("ada.m", ["ada.m.pose.csv", "ada.m.table-1.m"]),
        ("ben", ["ben.table.csv"]),
        ("c.table", ["x.csv"]),
    ]
    names = [Path(each.name).name for each in found]
    assert names == ["ada.csv", "ada.m", "ben.table.csv", "c.table"]
    [alone] = all_handed_in([tmp_path / "ben.table.csv"], parts={"table"})
    assert alone.learner == "ben"


def test_hidden_and_system_files_and_the_output_are_skipped(tmp_path: Path) -> None:
    save(
        tmp_path, "anna.json", ".DS_Store", "._anna.json", "__MACOSX/anna.json", "Thumbs.db",
        "~$anna.json", "anna.json~", "bert/.git/config", "bert/answer.json", "grades.csv",
    )  # fmt: skip
    found = all_handed_in([tmp_path], left_out=[tmp_path / "grades.csv"])
    assert [told(each) for each in found] == [("anna", ["anna.json"]), ("bert", ["answer.json"])]


def test_files_named_by_a_platform_are_grouped_by_student(tmp_path: Path) -> None:
    save(
        tmp_path,
        "Ada Lovelace_12_assignsubmission_file_/answer.json",
        "Ada Lovelace_12_assignsubmission_onlinetext_/onlinetext.html",
        "Ada Lovelace_13_assignsubmission_file_table.csv",
        "Ada Lovelace_13_assignsubmission_file_pose.tex",
        "boolegeorge_LATE_100_2001_table.csv",
        "boolegeorge_LATE_100_2002_pose-1.tex",
    )
    assert students(tmp_path) == [
        ("Participant 12", ["answer.json", "onlinetext.html"]),
        ("Participant 13", ["pose.tex", "table.csv"]),
        ("100", ["table.csv", "pose-1.tex"]),
    ]
    names = [Path(each.name).name for each in all_handed_in([tmp_path])]
    assert names == ["Ada Lovelace_12", "Ada Lovelace_13", "boolegeorge_100"]


def test_the_index_of_a_platform_is_no_student(tmp_path: Path) -> None:
    export, other = tmp_path / "export", tmp_path / "other"
    name = "12-345 - Ada Lovelace - Nov 20, 2026 5.31 PM"
    save(export, f"{name} - table.csv", f"{name} - pose.csv", "index.html")
    save(other, f"{name} - table.csv", "anna.csv", "index.html")
    assert students(export) == [("Ada Lovelace", ["pose.csv", "table.csv"])]
    assert [learner for learner, _ in students(other)] == ["Ada Lovelace", "anna", "index"]
    with zipfile.ZipFile(tmp_path / "export.zip", "w") as archive:
        for file in export.iterdir():
            archive.write(file, file.name)
    assert students(tmp_path / "export.zip") == students(export)


def test_a_zip_file_without_a_file_is_a_problem(tmp_path: Path) -> None:
    save(tmp_path, "anna/table.csv")
    with zipfile.ZipFile(tmp_path / "anna/pose.zip", "w") as archive:
        archive.writestr("folder/", "")
        archive.writestr("__MACOSX/._pose.csv", "")
    [found] = all_handed_in([tmp_path])
    files = [(file.name, file.problem) for file in found.files()]
    assert files == [("pose.zip", "holds no file"), ("table.csv", "")]


def test_a_folder_may_belong_to_one_student(tmp_path: Path) -> None:
    save(tmp_path, "table.csv", "more/pose.tex")
    [found] = all_handed_in([tmp_path], folder_is_one=True)
    assert told(found) == (tmp_path.name, ["more/pose.tex", "table.csv"])


def test_paths_keep_their_order_and_may_be_named_twice(tmp_path: Path) -> None:
    save(tmp_path, "b.json", "a.json")
    paths = [tmp_path / "b.json", tmp_path, tmp_path / "b.json"]
    assert [each.learner for each in all_handed_in(paths)] == ["b", "a", "b", "b"]


def test_standard_input_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b'{"answers": {}}')))
    [found] = all_handed_in([Path("-")])
    assert [file.read() for file in found.files()] == [b'{"answers": {}}']


@needs_links
def test_links_are_followed_only_within_their_folder(tmp_path: Path) -> None:
    folder = tmp_path / "class"
    save(tmp_path, "secret.json", "shared/x.json")
    save(folder, "anna/answer.json", "bert/mine.json", "carl.json")
    (folder / "dora.json").symlink_to(tmp_path / "secret.json")
    (folder / "emil.json").symlink_to("carl.json")
    (folder / "fred").symlink_to(tmp_path / "shared")
    (folder / "gone.json").symlink_to("nothing.json")
    (folder / "bert/own.json").symlink_to("mine.json")
    (folder / "bert/theirs.json").symlink_to("../anna/answer.json")
    (folder / "bert/up").symlink_to("..")
    problems = {
        str(file.path.relative_to(folder)): file.problem
        for each in all_handed_in([folder])
        for file in each.files()
    }
    out = "is a symbolic link out of the folder"
    assert problems == {
        "anna/answer.json": "",
        "bert/mine.json": "",
        "bert/own.json": "",
        "bert/theirs.json": out,
        "bert/up": out,
        "carl.json": "",
        "dora.json": out,
        "emil.json": "",
        "fred": out,
        "gone.json": "is a symbolic link to nothing",
    }


@needs_links
def test_a_link_named_by_the_caller_is_followed(tmp_path: Path) -> None:
    save(tmp_path, "real/anna.json")
    (tmp_path / "file.json").symlink_to("real/anna.json")
    (tmp_path / "folder").symlink_to("real")
    paths = [tmp_path / "file.json", tmp_path / "folder"]
    files = [file for each in all_handed_in(paths) for file in each.files()]
    assert [file.read() for file in files] == [b"{}", b"{}"]


def test_a_folder_over_the_limits_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(handed_in, "MAX_FILES", 3)
    save(tmp_path, *(f"many/{i}/x.json" for i in range(3)), "many/4.json")
    save(tmp_path, "deep/1/2/3/4/5/6/7/8/9/x.json", "fine/x.json")
    found = {each.learner: each for each in all_handed_in([tmp_path])}
    with pytest.raises(UnusableFileError, match="nested more than 8 deep"):
        found["deep"].files()
    with pytest.raises(UnusableFileError, match="more than 3 files"):
        found["many"].files()
    assert len(found["fine"].files()) == 1


@pytest.mark.skipif(os.name == "nt", reason="has no named pipes")
def test_a_pipe_is_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "anna.json")
    [found] = all_handed_in([tmp_path])
    [file] = found.files()
    with pytest.raises(UnusableFileError, match="pipe"):
        file.read()


def test_the_own_name_of_a_file_has_no_path_and_no_name_of_a_platform(tmp_path: Path) -> None:
    moodle = "Ada Byron_1234_assignsubmission_file_"
    save(tmp_path, f"class/{moodle}/planar-rr/table.csv", f"{moodle}table.csv", "anna.table.csv")
    paths = [tmp_path / each for each in ("class", f"{moodle}table.csv", "anna.table.csv")]
    names = [file.own_name for found in all_handed_in(paths) for file in found.files()]
    assert names == ["planar-rr/table.csv", "table.csv", "anna.table.csv"]
