import pytest
from dh_grader.submissions import platform_name


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
