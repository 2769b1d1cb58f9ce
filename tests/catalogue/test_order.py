"""Test the order of the catalogue, and its descriptions of exercises."""

import re
from pathlib import Path

from dh_grader.catalogue import Exercise, by_level, exercise_after, read_exercise

from tests.shipped import shipped_exercises

FILE = """
title = "A part"
source = "The lecture"
{}
statement = "Turn."
[[parts]]
id = "turn"
kind = "rotation"
title = "A turn"
prompt = "Turn."
steps = [{{ axis = "x", angle = "pi/2" }}]
"""


def exercise(name: str, fields: str = "") -> Exercise:
    return read_exercise(Path(f"{name}.toml"), FILE.format(fields))


def test_exercises_are_sorted_by_level_and_order() -> None:
    given = [
        exercise("old"),
        exercise("last", 'level = "industrial"\norder = 1'),
        exercise("c", 'level = "start"'),
        exercise("b", 'level = "start"\norder = 2'),
        exercise("a", 'level = "start"\norder = 10'),
        exercise("arm", 'level = "arms"'),
    ]
    groups = [(heading, [each.id for each in group]) for heading, group in by_level(given)]
    assert groups == [
        ("Start here", ["b", "a", "c"]),
        ("Arms", ["arm"]),
        ("Industrial robots", ["last"]),
        ("More exercises", ["old"]),
    ]
    following = {each.id: exercise_after(each.id, given) for each in given}
    assert {name: found and found.id for name, found in following.items()} == {
        "b": "a",
        "a": "c",
        "c": "arm",
        "arm": "last",
        "last": "old",
        "old": None,
    }


def test_fields_of_the_catalogue_do_not_change_the_version() -> None:
    old = exercise("old")
    new = exercise("old", 'level = "arms"\norder = 3\nminutes = 5\nsummary = "x"\nkeywords = ["y"]')
    assert new.version == old.version
    assert (new.level, new.order, new.minutes) == ("arms", 3, 5)
    assert (new.summary, new.keywords) == ("x", ("y",))
    assert (old.level, old.order, old.minutes, old.summary) == (None, None, None, "")


def test_shipped_titles_are_unique_and_name_no_convention() -> None:
    titles = [each.title for each in shipped_exercises().values()]
    assert len({title.casefold() for title in titles}) == len(titles)
    named = re.compile("standard|modified|distal|proximal", re.IGNORECASE)
    assert [title for title in titles if named.search(title)] == []


def test_shipped_exercises_have_a_place_and_a_description() -> None:
    shipped = shipped_exercises().values()
    places = [(each.level, each.order) for each in shipped]
    assert None not in {part for place in places for part in place}
    assert len(set(places)) == len(places)
    # The summary is one line, without maths that the catalogue would show as it is written.
    assert [e.id for e in shipped if not 20 <= len(e.summary) <= 110 or "$" in e.summary] == []
    assert [e.id for e in shipped if not e.minutes or not 5 <= e.minutes <= 90] == []
    assert next(iter(shipped)).id == "planar-rr"


def test_conventions_are_those_that_the_parts_ask_for() -> None:
    found = {name: each.conventions for name, each in shipped_exercises().items()}
    assert found["scara"] == ("standard",)
    assert found["planar-rrr"] == ("modified",)
    assert found["simple-twist"] == ()


def test_distal_and_proximal_are_said_once_in_brackets() -> None:
    for each in shipped_exercises().values():
        said = re.findall(r".?\b(?:distal|proximal)\b.?", each.statement)
        assert said in ([], ["(distal)"], ["(proximal)"]), each.id
        assert not re.search("distal|proximal", "".join(part.prompt for part in each.parts))
