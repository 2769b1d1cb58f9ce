import pytest
from dh_grader.kinematics import Convention
from dh_grader.variants.robots import ALL_NUMBERS, PracticeId, practice_id


@pytest.mark.parametrize("number", [0, 35, 36, 1295, 10**9, ALL_NUMBERS - 1])
def test_an_id_is_read_as_it_is_written(number: int) -> None:
    name = PracticeId(3, Convention.MODIFIED, number)
    assert practice_id(str(name)) == name
    assert int(name.seed, 36) == number


@pytest.mark.parametrize(
    "text",
    [
        "practice-2-standard", "practice-2-standard~", "practice-0-standard~a",
        "practice-5-standard~a", "practice-2-other~a", "practice-2-standard~01",
        "practice-2-standard~A", "practice-2-standard~123456789", "practice-2-standard~a\n",
        "practice-²-standard~a", "scara", "scara~a",
    ],
)  # fmt: skip
def test_other_texts_are_no_robots(text: str) -> None:
    assert practice_id(text) is None


def test_the_first_robot_follows_the_last_one() -> None:
    last = PracticeId(1, Convention.STANDARD, ALL_NUMBERS - 1)
    assert last.following().number == 0
