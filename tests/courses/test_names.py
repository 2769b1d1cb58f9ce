from service.contract.courses import CourseLearner
from service.courses.names import told_apart


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
