import json

from tests.formats.submissions import cases, document


def test_each_file_is_a_line_that_is_the_entry_of_the_list() -> None:
    submissions = list(cases().values())
    text = document("jsonl", *submissions)
    listed = json.loads(document("json", *submissions))
    assert [json.loads(line) for line in text.split("\n")[:-1]] == listed
    # The assignment has two files.
    assert len(listed) == len(submissions) + 1


def test_no_submission_is_no_line() -> None:
    assert document("jsonl") == ""
