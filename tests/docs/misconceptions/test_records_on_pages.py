"""The lists of misconceptions in docs/ are complete and current."""

from collections import Counter
from pathlib import Path

from dh_grader.grading.diagnosis.lists import WrongPosition
from dh_grader.grading.misconception import all_records

from tests.docs.misconceptions.records import DOCS, PAGES, kinds_in, records_in, written
from tests.together import together

MESSAGES = (DOCS / "messages.md").read_text(encoding="utf-8")


@together("page", PAGES)
def test_a_page_is_what_the_records_say(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert written(text) == text, "run `python -m tests.docs.misconceptions.records`"


def test_every_record_is_in_a_table() -> None:
    listed = records_in([name for name, _ in kinds_in(MESSAGES)])
    left_out = {record.name for record in all_records() if record.codes} - {
        record.name for record in listed
    }
    assert left_out == set(), "name the kind of case in a mark of docs/messages.md"


def test_no_kind_is_in_two_tables() -> None:
    names = Counter(name for name, _ in kinds_in(MESSAGES))
    assert [name for name, count in names.items() if count > 1] == []


def test_a_list_is_written_between_its_marks() -> None:
    page = "## A\n<!-- codes: WrongPosition -->\nold\n<!-- end -->\nkept\n"
    own = {code for each in all_records() if each.of is WrongPosition for code in each.codes}
    codes = ", ".join(f"`{code}`" for code in sorted(own))
    assert written(page) == page.replace("old\n", f"{codes}.\n")
