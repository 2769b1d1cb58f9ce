import pytest

from service.submissions.platform_names import PlatformName, platform_name


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
        ("lovelaceada_12345_678_answer.json", "lovelaceada_12345", "12345", "answer.json"),
        ("lovelaceada_LATE_12345_678_a_b.csv", "lovelaceada_12345", "12345", "a_b.csv"),
    ],
)  # fmt: skip
def test_the_student_is_found(name: str, student: str, learner: str, file: str) -> None:
    assert platform_name(name) == PlatformName(student, learner, file)


@pytest.mark.parametrize(
    "name", ["anna.json", "anna_1.json", "table_2_3.csv", "hw_1_2_x.json", "_12345_678_", ""]
)
def test_a_name_that_somebody_chose_is_no_platform_s(name: str) -> None:
    assert platform_name(name) is None
