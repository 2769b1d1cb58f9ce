from dataclasses import dataclass

from dh_grader.contract.courses import CourseLearner
from dh_grader.courses import place_of, told_apart


def test_learners_of_one_name_are_told_apart() -> None:
    people = [
        CourseLearner(learner="u1", name="Alan Turing", email="alan@example.edu"),
        CourseLearner(learner="u2", name="Ada Lovelace", email="ada@example.edu"),
        CourseLearner(learner="u3", name="Alan Turing"),
    ]
    assert told_apart(people) == {
        "u1": "Alan Turing (alan@example.edu)",
        "u2": "Ada Lovelace",
        "u3": "Alan Turing (u3)",
    }


@dataclass
class Person:
    """A learner of a course, as in the database."""

    name: str
    family_name: str | None = None
    learner: str = "u1"


def test_learners_are_sorted_by_family_name_else_by_name() -> None:
    in_order = [
        Person("Élodie Adam", "Adam"),
        Person("Zoë Amsel", "Amsel"),
        Person("amsel, anna"),
        Person("Ångström, Zoë"),
        Person("Ada de la Cruz", "de la Cruz"),
        Person("Grace Hopper", "Hopper", "u1"),
        Person("Grace Hopper", "Hopper", "u2"),
        Person("Ada Żuk", "Żuk"),
    ]
    backwards = in_order[::-1]
    assert sorted(backwards, key=place_of) == in_order
