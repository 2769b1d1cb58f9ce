from tests.formats.documents.test_csv import read


def test_a_line_for_each_learner_with_the_headings_of_moodle() -> None:
    head, right, wrong = read("right", "wrong", format_name="gradebook")
    # mod/assign of Moodle writes and reads these headings in its grading worksheet.
    assert head == ["Identifier", "Grade", "Maximum Grade", "Feedback comments"]
    assert right[1:3] == ["16", "16"]
    assert wrong[1] == "10.789474"
    assert wrong[3] == "Denavit-Hartenberg table: 3.79 / 8; Pose of the end effector: 7 / 8"


def test_nobody_gets_0_for_a_file_that_cannot_be_used() -> None:
    _, unusable = read("unusable", format_name="gradebook")
    assert unusable[:3] == ["b", "", "16"]
    assert "is no JSON" in unusable[3]
