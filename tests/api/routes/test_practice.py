"""Test the routes for generated robots."""

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.kinematics import Convention
from dh_grader.variants.robots import (
    MOST_ROBOTS,
    CatalogueWithPractice,
    PracticeId,
    Situation,
    _memoized,
    has_situation,
    practice_id,
    robot_exercise,
)

from tests.variants.robots.checks import lazy_share


@pytest.mark.long
def test_a_robot_is_found_by_its_id_everywhere(client: httpx.Client) -> None:
    dealt = client.get("/v1/practice/next?level=2&convention=modified").json()
    assert dealt["level"] == 2
    path = f"/v1/exercises/{dealt['id']}"
    shown = client.get(path).json()
    assert shown["parts"][0]["shape"]["convention"] == "modified"
    assert client.get(f"{path}/figure.svg").status_code == 200
    report = client.post(f"{path}/grade", json={"answers": {"table": {"rows": []}}}).json()
    assert report["points"] == 0
    drawing = client.post("/v1/frames", json={"exercise": dealt["id"]})
    assert drawing.status_code == 200
    assert dealt["id"] not in client.get("/v1/exercises").text
    assert "robot_table" not in client.get(path).text


def test_the_next_robot_follows_the_last_one(client: httpx.Client) -> None:
    first = "practice-1-standard~5"
    following = client.get(f"/v1/practice/next?level=1&after={first}").json()
    assert following["id"] == "practice-1-standard~6"
    harder = client.get(f"/v1/practice/next?level=2&convention=modified&after={first}").json()
    assert harder["id"] == "practice-2-modified~6"
    assert harder["difficulty"] > following["difficulty"]


@pytest.mark.long
def test_a_robot_in_which_zeros_earn_much_is_not_dealt(client: httpx.Client) -> None:
    # In robot 1000 of level 1 they earn more than a quarter, because marks give one row up.
    for number in (998, 999, 1000):
        last = PracticeId(1, Convention.MODIFIED, number)
        dealt = client.get(f"/v1/practice/next?level=1&convention=modified&after={last}").json()
        later = (last.following(steps) for steps in range(1, 9))
        fair = next(each for each in later if lazy_share(robot_exercise(each)) <= 0.25)
        assert dealt["id"] == str(fair)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("favour", Situation)
def test_a_situation_may_be_wished(client: httpx.Client, favour: Situation) -> None:
    for after in ("practice-1-standard~5", "practice-3-standard~zz"):
        query = f"level=2&after={after}&favour={favour.value}"
        name = practice_id(client.get(f"/v1/practice/next?{query}").json()["id"])
        assert name is not None
        assert has_situation(name, favour)


@pytest.mark.parametrize(
    "query",
    ["level=0", "level=5", "level=1&after=scara", "level=1&convention=x", "level=1&favour=x"],
)
def test_other_queries_are_refused(client: httpx.Client, query: str) -> None:
    assert client.get(f"/v1/practice/next?{query}").status_code == 422


def test_unknown_robots_are_no_exercises(client: httpx.Client) -> None:
    for name in ("practice-9-standard~a", "practice-1-standard~01", "scara~a"):
        assert client.get(f"/v1/exercises/{name}").status_code == 404


@pytest.mark.long
def test_many_seeds_do_not_fill_the_memory() -> None:
    robots = CatalogueWithPractice({})
    for number in range(1, 20):
        assert robots[f"practice-1-standard~{number}"].parts
    assert _memoized.cache_info().maxsize == MOST_ROBOTS
    assert len(robots) == 0
    assert application(robots) is not None
