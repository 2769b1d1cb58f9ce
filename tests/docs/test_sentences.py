"""docs/sentences.md lists every sentence of a message, each with an example."""

import pytest

from tests.docs import sentences
from tests.docs.sentences import Said, chosen, page, shown
from tests.docs.templates import Template, templates_in

# The number of sentences without an example. It may only shrink.
UNMET = 0


@pytest.mark.long
def test_the_page_is_up_to_date() -> None:
    written = (sentences.ROOT / "docs" / "sentences.md").read_text(encoding="utf-8")
    assert written == page(), "run `python -m tests.docs.sentences > docs/sentences.md`"
    assert written.partition("## Without an example")[2].count("\n- ") <= UNMET


@pytest.mark.parametrize(
    ("source", "texts"),
    [
        ('f("The sign is wrong.")', ["The sign is wrong."]),
        ('f(f"Joint {i} turns about {z}, so.")', ["Joint … turns about …, so."]),
        (
            "f(f\"The sign of {a} is wrong: {'too long' if b else c}.\")",
            ["too long", "The sign of … is wrong: …."],
        ),
        ('M = "This was read as {name} here."', ["This was read as … here."]),
        ('f("one", "two words")', ["two words"]),
        ('say("Joint {joint} turns about {z}.", joint=3, z=z)', ["Joint … turns about …."]),
        (
            'say(\'Write {{"a": …}} here.\', x=say("two words"))',
            ['Write {"a": …} here.', "two words"],
        ),
        ('say_count("one row", "{count} of the rows", count=n)', ["one row", "… of the rows"]),
        ('SIGN = template("The sign of {name} is wrong.")', ["The sign of … is wrong."]),
        ('"""A docstring of some words."""', []),
        ('def f():\n    """A docstring of some words."""', []),
        ('raise ValueError("a text for programmers")', []),
        ('assert x, "a text for programmers"', []),
        ('R = re.compile(r"\\s* as well")', []),
    ],
)
def test_templates_are_found(source: str, texts: list[str]) -> None:
    assert [template.text for template in templates_in({"a.py": source})] == texts


def template(*pieces: str, file: str = "a.py") -> Template:
    return Template(pieces, file)


def said(code: str, sentence: str, correction: str = "") -> Said:
    return Said(code, sentence, correction, "", "x")


def test_a_template_matches_any_text_in_its_gaps() -> None:
    turns = template("Joint ", " turns about ", ".")
    assert turns.is_met_by("Look: Joint 1 turns about z.")
    assert not turns.is_met_by("Joint 1 slides along z.")
    assert template("Nothing depends on it: ").is_met_by("Nothing depends on it: z.")


def test_a_clause_may_begin_a_sentence() -> None:
    clause = template("joint ", " stands still")
    assert clause.is_met_by("It may be that joint 1 stands still.")
    assert clause.is_met_by("Joint 1 stands still.")
    assert template("stands still here").is_met_by("Stands still here.")
    assert not template("Joint ", " stands still").is_met_by("It may be that joint 1 stands still.")


@pytest.mark.long
def test_the_first_message_with_a_sentence_is_chosen() -> None:
    known = [(template("The sign of ", " is wrong."), frozenset({"sign"}))]
    messages = [said("x", "No."), said("sign", "The sign of a is wrong."), said("sign", "The sign")]
    messages.append(said("sign", "The sign of d is wrong."))
    rows, unmet = chosen(messages, known)
    assert [row.said for row in rows] == messages[1:2]
    assert unmet == []


def test_the_words_of_a_correction_count() -> None:
    known = [(template("Turn it round."), frozenset({"sign"}))]
    rows, unmet = chosen([said("sign", "It is wrong.", "Turn it round.")], known)
    assert (len(rows), unmet) == (1, [])


def test_a_short_sentence_does_not_match_a_message_of_another_file() -> None:
    short = template("", " is wrong")
    assert chosen([said("b", "The name is wrong.")], [(short, frozenset({"a"}))]) == ([], [short])
    long = template("The name of this joint is not known here.")
    rows, _ = chosen([said("b", long.text)], [(long, frozenset({"a"}))])
    assert len(rows) == 1


def test_a_short_sentence_may_be_the_beginning_of_another_file_s() -> None:
    short = template("This comes from")
    rows, _ = chosen([said("b", "This comes from the inverse.")], [(short, frozenset({"a"}))])
    assert len(rows) == 1


@pytest.mark.parametrize(
    ("answer", "text"),
    [
        ("a1, 0", "a1, 0"),
        ([["c1", 0], [1, "s1"]], "c1, 0; 1, s1"),
        ({"rows": [{"a": 0, "alpha": "90°", "d": 1, "theta": "q1"}, ["l"]]}, "0, 90°, 1, q1; l"),
        ({"convention": "modified", "rows": [[1]]}, "convention: modified; 1"),
        ({"none": True}, "none: true"),
        ({"a": 1, "alpha": 2, "d": 3, "theta": 4, "none": True}, "1, 2, 3, 4, none: true"),
    ],
)
def test_an_answer_as_short_text(answer: object, text: str) -> None:
    assert shown(answer) == text
