from tests.formats.documents.test_csv import read


def test_each_learner_is_a_line_under_moodles_headings() -> None:
    head, right, wrong = read("right", "wrong", format_name="gradebook")
    # Moodle (mod/assign) uses these headings in its grading worksheet.
    assert head == ["Identifier", "Grade", "Maximum Grade", "Feedback comments"]
    assert right[1:3] == ["16", "16"]
    assert wrong[1] == "11"
    assert wrong[3] == "Denavit-Hartenberg table: 4 / 8; Pose of the end effector: 7 / 8"


def test_an_unusable_file_gets_no_grade() -> None:
    _, unusable = read("unusable", format_name="gradebook")
    assert unusable[:3] == ["b", "", "16"]
    assert "is no JSON" in unusable[3]
