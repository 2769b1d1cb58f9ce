"""Test files and folders that are handed in."""

import io
import os
import sys
import tracemalloc
import zipfile
from pathlib import Path
from typing import Any

import pytest
from dh_grader.submissions import files as handed_in
from dh_grader.submissions import platform_name
from dh_grader.submissions.documents import UnusableFileError
from dh_grader.submissions.files import ClassEntry, HandedIn, UnusableClassError, all_handed_in

# --- The program finds the students and their files in the folders of a course

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


def zipped(path: Path, members: dict[str, str | bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


ADA, BEN = "Ada Byron_1234_assignsubmission_file_", "Ben Okri_1235_assignsubmission_file_"
DOWNLOAD: dict[str, str | bytes] = {f"{ADA}/table.csv": "ada", f"{BEN}/table.csv": "ben"}
IN_DOWNLOAD = [("Participant 1234", ["table.csv"]), ("Participant 1235", ["table.csv"])]


@pytest.mark.parametrize(
    "path", ["../x.csv", "a/../../x.csv", "/etc/x.csv", "C:/x.csv", "D:\\x.csv", "..\\x.csv"]
)
@pytest.mark.parametrize("place", ["class", "student"])
def test_a_path_out_of_a_zip_file_is_listed_and_not_read(
    tmp_path: Path, path: str, place: str
) -> None:
    if place == "class":
        given = zipped(tmp_path / "class.zip", {f"{BEN}/t.csv": "", f"../{ADA}/{path}": "0"})
    else:
        (tmp_path / "class" / ADA).mkdir(parents=True)
        zipped(tmp_path / "class" / ADA / "mine.zip", {path: "0"})
        given = tmp_path / "class"
    before = sorted(tmp_path.rglob("*"))
    ada, *_ = all_handed_in([given])
    assert ada.learner == "Participant 1234"
    [file] = ada.files()
    assert file.name.endswith("x.csv")
    with pytest.raises(UnusableFileError) as error:
        file.read()
    assert path in str(error.value)
    assert "leads out of it" in str(error.value)
    assert sorted(tmp_path.rglob("*")) == before


def test_names_that_only_windows_reserves_and_harmless_steps_are_read(tmp_path: Path) -> None:
    names = [f"./{ADA}/aux.csv", f"{ADA}\\sub\\nul.csv", f"{BEN}//con"]
    given = zipped(tmp_path / "class.zip", dict.fromkeys(names, "0"))
    found = list(all_handed_in([given]))
    assert [told(each) for each in found] == [
        ("Participant 1234", ["aux.csv", "sub/nul.csv"]),
        ("Participant 1235", ["con"]),
    ]
    assert {file.read() for each in found for file in each.files()} == {b"0"}


def test_names_in_utf_8_need_no_flag(tmp_path: Path) -> None:
    given = zipped(tmp_path / "class.zip", {"Jörg 李_7_assignsubmission_file_/lösung.csv": "0"})
    # Archive Utility on a Mac does not set the flag. It is in the header and in the directory.
    content = given.read_bytes()
    flags = b"\x00\x08"
    assert content.count(b"\x14\x00" + flags) == 2
    given.write_bytes(content.replace(b"\x14\x00" + flags, b"\x14\x00\x00\x00"))
    [found] = all_handed_in([given])
    assert found.person == "Jörg 李"
    assert [(file.name, file.read()) for file in found.files()] == [("lösung.csv", b"0")]


def packed() -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, each in DOWNLOAD.items():
            archive.writestr(name, each)
    return content.getvalue()


def test_the_download_is_found_wherever_the_tutor_has_put_it(tmp_path: Path) -> None:
    download = packed()
    given = []
    for name in ("alone", "beside", "unpacked", "two deep"):
        (tmp_path / name).mkdir()
        given.append(tmp_path / name)
    (tmp_path / "alone" / "ROB1-4711.zip").write_bytes(download)
    (tmp_path / "beside" / "ROB1-4711.zip").write_bytes(download)
    (tmp_path / "beside" / "points.csv").write_text("points", encoding="utf-8")
    for name in DOWNLOAD:
        save(tmp_path / "unpacked" / "ROB1-4711", name)
        save(tmp_path / "two deep" / "HW3" / "ROB1-4711", name)
    given += [
        zipped(tmp_path / "again.zip", {"ROB1-4711.zip": download}),
        zipped(tmp_path / "folder.zip", {"HW3/ROB1-4711.zip": download}),
        zipped(tmp_path / "with.zip", {"HW3/d.zip": download, "HW3/points.csv": "points"}),
        zipped(tmp_path / "unpacked.zip", {f"HW3/R/{name}": "0" for name in DOWNLOAD}),
        zipped(
            tmp_path / "outputs.zip",
            {"HW3/points.csv": "", **{f"HW3/R/{name}": "0" for name in DOWNLOAD}},
        ),
    ]
    for path in given:
        found = list(all_handed_in([path], is_output=lambda entry: entry.name == "points.csv"))
        assert [told(each) for each in found] == IN_DOWNLOAD, path
        contents = [file.read() for each in found for file in each.files()]
        assert contents in ([b"ada", b"ben"], [b"{}", b"{}"], [b"0", b"0"])


def test_the_zip_file_or_folder_of_a_student_is_no_download(tmp_path: Path) -> None:
    (tmp_path / ADA).mkdir()
    (tmp_path / ADA / "mine.zip").write_bytes(packed())
    save(tmp_path, "anna/table.csv", "anna/pose.csv", "bert/robot_10_200_a.csv", "bert/x.csv")
    zipped(tmp_path / "cleo.zip", {"table.csv": "0", "pose.csv": "0"})
    assert [learner for learner, _ in students(tmp_path)] == [
        "Participant 1234", "anna", "bert", "cleo",
    ]  # fmt: skip


def test_a_student_in_two_downloads_is_refused(tmp_path: Path) -> None:
    (tmp_path / "ROB1.zip").write_bytes(packed())
    for name in DOWNLOAD:
        save(tmp_path / "ROB1", name)
    with pytest.raises(UnusableClassError) as error:
        list(all_handed_in([tmp_path]))
    assert "Give only one of them." in str(error.value)
    assert "ROB1.zip" in str(error.value)


def test_a_download_that_cannot_be_read_in_a_zip_file_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = zipped(tmp_path / "again.zip", {"ROB1.zip": packed()})
    monkeypatch.setattr(handed_in, "MAX_INNER_ARCHIVE", 100)
    with pytest.raises(UnusableClassError, match=r"Unpack .*again\.zip, and give ROB1\.zip"):
        list(all_handed_in([given]))


def test_a_zip_file_that_grows_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr(f"{ADA}/table.csv", b"0" * 8_000_000)
        archive.writestr(f"{BEN}/table.csv", b"0")
    given = zipped(tmp_path / "again.zip", {"ROB1.zip": bomb.getvalue()})
    assert given.stat().st_size < 40_000
    tracemalloc.start()
    with pytest.raises(UnusableClassError, match="too large"):
        list(all_handed_in([given]))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 4_000_000


def test_outputs_among_the_submissions_are_left_out(tmp_path: Path) -> None:
    save(tmp_path, "anna.csv", "points.csv", "class/index.html", f"{ADA}/points.csv")
    seen = []

    def is_output(entry: ClassEntry) -> bool:
        seen.append((entry.name, list(entry.inside()), entry.start(""), entry.start("index.html")))
        return entry.name in ("points.csv", "class")

    found = all_handed_in([tmp_path], is_output=is_output)
    # What a platform has named is from a student.
    assert [told(each) for each in found] == [
        ("Participant 1234", ["points.csv"]),
        ("anna", ["anna.csv"]),
    ]
    assert sorted(seen) == [
        ("anna.csv", [], b"{}", b""),
        ("class", ["index.html"], b"", b"{}"),
        ("points.csv", [], b"{}", b""),
    ]


@pytest.mark.parametrize("name", ["{}.csv", "{}/a.csv"])
def test_the_directory_of_a_zip_file_is_read_once(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    archive = zipped(tmp_path / "class.zip", {name.format(i): "0 0 0 q1" for i in range(40)})
    opened = []

    class Counted(zipfile.ZipFile):
        def __init__(self, *arguments: Any) -> None:
            opened.append(arguments)
            super().__init__(*arguments)

    monkeypatch.setattr(zipfile, "ZipFile", Counted)

    def is_output(entry: ClassEntry) -> bool:
        assert entry.start("") or entry.start("a.csv")
        return False

    assert len([*all_handed_in([archive], is_output=is_output)]) == 40
    assert len(opened) == 1


# --- Platform names


@pytest.mark.parametrize(
    ("name", "student", "learner", "file"),
    [
        (
            "Ada Lovelace_1234_assignsubmission_file_",
            "Ada Lovelace_1234", "Participant 1234", "",
        ),
        (
            "Ada_Lovelace_1234_assignsubmission_file_pose_2.tex",
            "Ada_Lovelace_1234", "Participant 1234", "pose_2.tex",
        ),
        (
            "Ada Lovelace_1234_assignsubmission_onlinetext_onlinetext.html",
            "Ada Lovelace_1234", "Participant 1234", "onlinetext.html",
        ),
        # Newer versions of Moodle have no _ at the end of a folder's name.
        (
            "Ada Lovelace_1234_assignsubmission_file",
            "Ada Lovelace_1234", "Participant 1234", "",
        ),
        (
            "Ada Lovelace_1234_assignsubmission_onlinetext",
            "Ada Lovelace_1234", "Participant 1234", "",
        ),
        ("Group 3_77_assignsubmission_file", "Group 3_77", "Participant 77", ""),
        ("lovelaceada_12345_678_answer.json", "lovelaceada_12345", "12345", "answer.json"),
        ("lovelaceada_LATE_12345_678_a_b.csv", "lovelaceada_12345", "12345", "a_b.csv"),
        # Canvas keeps underscores and the letters of all scripts.
        ("de_souzaana_12345_678_x.csv", "de_souzaana_12345", "12345", "x.csv"),
        ("शर्माकविता_LATE_12345_678_x.csv", "शर्माकविता_12345", "12345", "x.csv"),
        ("lovelaceada_12345_678_table-1.csv", "lovelaceada_12345", "12345", "table-1.csv"),
        ("lovelaceada_LATE_12345_text.html", "lovelaceada_12345", "12345", "text.html"),
        ("lovelaceada_12345_link.html", "lovelaceada_12345", "12345", "link.html"),
        ("anon_x7Gh2_678_table.csv", "anon_x7Gh2", "anon_x7Gh2", "table.csv"),
        ("LATE_anon_x7Gh2_678_table.csv", "anon_x7Gh2", "anon_x7Gh2", "table.csv"),
        # Brightspace.
        (
            "75842-1234567 - Ann-Marie Lee - Oct 3, 2026 405 PM",
            "Ann-Marie Lee_75842-1234567", "Ann-Marie Lee", "",
        ),
        (
            "75842-1234567 - Ada Byron - Nov 20, 2026 5.31 PM - dh - table.xlsx",
            "Ada Byron_75842-1234567", "Ada Byron", "dh - table.xlsx",
        ),
        # Blackboard.
        (
            "HW1_abyron_attempt_2026-10-03-16-05-33_dh_table.csv",
            "HW1_abyron", "abyron", "dh_table.csv",
        ),
        ("HW1_abyron_attempt_2026-10-03-16-05-33.txt", "HW1_abyron", "abyron", "attempt.txt"),
    ],
)  # fmt: skip
def test_the_student_in_a_platform_name_is_found(
    name: str, student: str, learner: str, file: str
) -> None:
    found = platform_name(name)
    assert found is not None
    assert (found.student, found.learner, found.file) == (student, learner, file)


@pytest.mark.parametrize(
    ("name", "person"),
    [
        ("Ada Lovelace_1234_assignsubmission_file_", "Ada Lovelace"),
        ("lovelaceada_LATE_12345_678_table.csv", "lovelaceada"),
        ("anon_x7Gh2_678_table.csv", ""),
        ("75842-1234567 - Ann-Marie Lee - Oct 3, 2026 405 PM", "Ann-Marie Lee"),
        ("HW1_abyron_attempt_2026-10-03-16-05-33.txt", "abyron"),
    ],
)
def test_the_person_in_a_platform_name_is_found(name: str, person: str) -> None:
    found = platform_name(name)
    assert found is not None
    assert found.person == person


@pytest.mark.parametrize(
    "name",
    [
        "anna.json",
        "anna_1.json",
        "table_2_3.csv",
        "hw_1_2_x.json",
        "_12345_678_",
        "12345_678_x.csv",
        "2024_lab_text.html",
        "anon_text.html",
        "my_text.html",
        f"Ada_{'1' * 300}_assignsubmission_file_",
        "",
    ],
)
def test_other_names_are_not_platform_names(name: str) -> None:
    assert platform_name(name) is None
