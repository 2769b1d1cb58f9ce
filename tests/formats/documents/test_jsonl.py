import json

from tests.formats.submissions import cases, document


def test_each_line_is_an_entry_of_the_json_list() -> None:
    submissions = list(cases().values())
    text = document("jsonl", *submissions)
    listed = json.loads(document("json", *submissions))
    assert [json.loads(line) for line in text.split("\n")[:-1]] == listed
    # The assignment has two files.
    assert len(listed) == len(submissions) + 1


def test_without_submissions_there_are_no_lines() -> None:
    assert document("jsonl") == ""
