"""Each learner gets a personal variant of an assigned exercise."""

import asyncio
import json
import logging
import re
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import httpx
import pytest
from dh_grader.access import OPEN_HERE
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.contract.courses import AssignmentChange, NewAssignment, NewLearner
from dh_grader.courses import CourseError, roll
from dh_grader.courses.assignments import (
    add_assignment,
    assigned,
    change_assignment,
    deal_again,
    learner_variants,
    pin_choices,
    terms_of,
)
from dh_grader.kinematics import COLUMNS
from dh_grader.store import AttemptFilter, GradesFormat
from dh_grader.store.regrades import Regrading
from dh_grader.store.results import (
    everything_of,
    exercise_statistics,
    forget,
    graded_attempts,
    written,
)
from dh_grader.store.tables import assignments, attempts, deals
from dh_grader.variants import built, seed_of
from sqlalchemy import func, select, update

from tests.courses.conftest import Class
from tests.store.recorded import regraded
from tests.variants.varied_files import VARY, varied

DEPLOYED = [f"seed{letter}" for letter in "abcdefghijkl"]
PLACE = "course=robots&assignment=homework"
BASE = "/v1/courses/robots/assignments/homework"
HAND_IN = f"{BASE}/attempts"


@pytest.fixture(scope="module")
def catalogue(catalogue: Mapping[str, Exercise]) -> Mapping[str, Exercise]:
    return {"scara": catalogue["scara"], "arm": varied()}


def assign(class_: Class, **more: Any) -> None:
    chosen = [{"exercise": "arm", "points": 8}, {"exercise": "scara", "points": 2}]
    fields = {"id": "homework", "title": "Homework", "exercises": chosen, "variants": True, **more}
    new = NewAssignment.model_validate(fields)
    class_.do(lambda it: add_assignment(it, "robots", new, {"arm", "scara"}))


def variants_of(class_: Class, learner: str, catalogue: Mapping[str, Exercise]) -> Any:
    return class_.do(lambda it: learner_variants(it, "robots", "homework", learner, catalogue))


def rows_of(exercise: Exercise, seed: str) -> list[list[str]]:
    robot = built(exercise, seed).robot
    return [[cell.text() for cell in row] for row in robot.tables[robot.convention].rows]


def test_a_seed_follows_from_the_secret_and_is_spread_evenly() -> None:
    seeds = {seed_of("s" * 64, f"learner {i}", "arm", 0) for i in range(200)}
    assert len(seeds) == 200
    assert all(re.fullmatch("[a-z0-9]{16}", seed) for seed in seeds)
    assert seed_of("s", "ada", "arm", 0) == seed_of("s", "ada", "arm", 0)
    others = ("t", "ada", "arm", 0), ("s", "bo", "arm", 0), ("s", "ada", "leg", 0)
    different = {seed_of(*each) for each in (*others, ("s", "ada", "arm", 1))}
    assert seed_of("s", "ada", "arm", 0) not in different
    assert len(different) == 4
    dealt = [seed_of("s", f"learner {i}", "arm", 0, DEPLOYED) for i in range(1200)]
    counts = [dealt.count(seed) for seed in DEPLOYED]
    # 100 each, with a deviation of 10.
    assert min(counts) > 50
    assert max(counts) < 150


def test_another_deployed_seed_changes_few_variants() -> None:
    learners = [f"learner {i}" for i in range(1200)]
    before = [seed_of("s", each, "arm", 0, DEPLOYED) for each in learners]
    after = [seed_of("s", each, "arm", 0, [*DEPLOYED, "more"]) for each in learners]
    changed = [new for old, new in zip(before, after, strict=True) if old != new]
    assert set(changed) == {"more"}
    assert len(changed) < 150


def test_learners_see_and_hand_in_their_own_variants(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_, solution="after_full")
    shown = {}
    for learner in ("ada", "grace"):
        [mine] = variants_of(class_, learner, catalogue)
        assert mine.variant == f"arm~{mine.seed}"
        variant = built(catalogue["arm"], mine.seed)
        told = class_.ask("GET", f"/v1/exercises/arm?{PLACE}", learner).json()
        assert told["id"] == "arm"
        assert told["statement"] == variant.statement
        assert told == class_.ask("GET", f"/v1/exercises/arm?{PLACE}", learner).json()
        [course] = class_.ask("GET", "/v1/me", learner).json()["courses"]
        assert course["assignments"][0]["exercises"][0]["title"] == variant.title
        right = {"table": {"rows": rows_of(catalogue["arm"], mine.seed)}}
        body = {"exercise": "arm", "answers": right}
        report = class_.ask("POST", HAND_IN, learner, "k1", **body).json()["report"]
        assert (report["points"], report["max_points"]) == (8, 8)
        assert report["exercise"] == "arm"
        graded = class_.ask("POST", f"/v1/exercises/arm/grade?{PLACE}", learner, answers=right)
        assert graded.json()["points"] == 8
        solution = class_.ask(
            "GET", "/v1/courses/robots/assignments/homework/solutions/arm", learner
        )
        assert solution.json()["exercise"] == "arm"
        shown[learner] = (mine.seed, told["statement"])
    assert shown["ada"][0] != shown["grace"][0]


def test_the_answer_to_another_variant_is_wrong(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_)
    [mine] = variants_of(class_, "ada", catalogue)
    own = rows_of(catalogue["arm"], mine.seed)
    all_rows = (rows_of(catalogue["arm"], str(seed)) for seed in range(99))
    answers = {"table": {"rows": next(rows for rows in all_rows if rows != own)}}
    answer = class_.ask("POST", HAND_IN, "ada", "k", exercise="arm", answers=answers)
    assert answer.json()["report"]["points"] < 8


@pytest.mark.long
def test_no_learner_sees_a_seed_that_counts(
    class_: Class, catalogue: Mapping[str, Exercise], caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG)
    assign(class_, solution="after_full", practice="open")
    [mine] = variants_of(class_, "ada", catalogue)
    right = {"table": {"rows": rows_of(catalogue["arm"], mine.seed)}}
    replies = [
        class_.ask("POST", HAND_IN, "ada", "k", exercise="arm", answers=right),
        class_.ask("POST", HAND_IN, "ada", "k", exercise="arm", answers={"table": 3}),
        class_.ask("POST", HAND_IN, "ada", "n", exercise="arm", answers={"legs": 3}),
        class_.ask("POST", HAND_IN, "ada", "m", exercise=f"arm~{mine.seed}", answers=right),
        class_.ask("GET", "/v1/me"),
        class_.ask("GET", "/v1/attempts"),
        class_.ask("GET", f"{BASE}/solutions/arm"),
        class_.ask("GET", "/v1/exercises"),
        class_.ask("GET", f"/v1/exercises/arm?{PLACE}"),
        class_.ask("GET", f"/v1/exercises/arm/figure.svg?{PLACE}"),
        class_.ask("POST", f"/v1/exercises/arm/grade?{PLACE}", answers={"table": "1 2\n3"}),
        class_.ask("POST", f"/v1/exercises/arm/grade?{PLACE}", answers={"legs": 1}),
        class_.ask("POST", f"/v1/preview?{PLACE}", exercise="arm", part="table", text="1 2\n3"),
        class_.ask("POST", f"/v1/preview?{PLACE}", exercise="arm", part="legs", text="1"),
        class_.ask("POST", f"/v1/previews?{PLACE}", exercise="arm", part="table", entries=[]),
        class_.ask("POST", f"/v1/frames?{PLACE}", exercise="arm", joints={"theta1": 9e99}),
        class_.ask("POST", f"/v1/frames?{PLACE}", exercise="arm"),
        class_.ask("GET", f"{BASE}/variants?learner=ada"),
        class_.ask("POST", f"{BASE}/variants", learner="ada", exercise="arm"),
        class_.ask("GET", f"/v1/exercises/arm~{mine.seed}/statistics"),
    ]
    first, second = [dict(zip(COLUMNS, row, strict=True)) for row in right["table"]["rows"]]
    wrong = {"table": {"rows": [{**first, "alpha": "0"}, second]}}
    replies += [
        class_.ask("POST", f"/v1/exercises/arm/solution?{PLACE}", answers=right),
        class_.ask(
            "POST", f"/v1/exercises/arm/choices?{PLACE}", part="table", rows=[first, second]
        ),
        class_.ask("POST", f"/v1/exercises/arm/grade?{PLACE}", answers=wrong),
    ]
    [found] = replies[-1].json()["parts"]
    [cell] = [cell for cell in found["rows"][0]["cells"] if cell["feedback"]]
    slip = {"part": "table", "row": "1", "cell": cell["label"], "code": cell["feedback"][0]["code"]}
    path = f"/v1/exercises/arm/hints?{PLACE}"
    replies += [class_.ask("POST", path, answers=wrong, step=i, **slip) for i in (1, 2, 3)]
    assert {each.status_code for each in replies[-6:]} == {200}
    recorded = replies[5].json()["attempts"]
    replies += [class_.ask("GET", f"/v1/attempts/{each['id']}") for each in recorded]
    statuses = [each.status_code for each in replies]
    assert statuses.count(200) + statuses.count(201) >= 11
    for reply in replies:
        if f"arm~{mine.seed}" in str(reply.request.url) or b"~" in reply.request.content:
            continue  # it repeats what the request says
        assert mine.seed not in reply.text + str(reply.headers), reply.request.url
    # Neither the log nor the data that are handed to the learner have it.
    logged = [each.getMessage() for each in caplog.records if each.name != "httpx"]
    assert all(mine.seed not in each for each in logged)
    data = class_.do(lambda it: everything_of(it, "ada"))
    assert mine.seed not in json.dumps(data)
    # A learner cannot ask which seed an attempt has.
    listed = class_.ask("GET", f"/v1/attempts?exercise=arm~{mine.seed}").json()["attempts"]
    assert listed == class_.ask("GET", "/v1/attempts?exercise=arm~other").json()["attempts"]
    terms = class_.do(lambda it: terms_of(it, "robots", "homework", "ada"))
    assert terms.variants is not None
    assert terms.variants not in repr(terms)


class TestAVariantThatCannotBeMade:
    # The file has a fault in nearly every variant, but not in the variant that is checked.
    @pytest.fixture
    def catalogue(self, catalogue: Mapping[str, Exercise]) -> Mapping[str, Exercise]:
        unreadable = ", ".join(['{ sign = "*", says = "down" }'] * 500)
        vary = VARY.replace('{ sign = "-", says = "down" }', unreadable)
        return {"scara": catalogue["scara"], "arm": varied(vary)}

    def test_the_learner_is_told_but_not_the_seed(
        self, class_: Class, catalogue: Mapping[str, Exercise], caplog: pytest.LogCaptureFixture
    ) -> None:
        caplog.set_level(logging.DEBUG)
        assign(class_, practice="open")
        # One variant in 501 can be made.
        while class_.ask("GET", f"/v1/exercises/arm?{PLACE}").status_code == 200:
            class_.do(lambda it: deal_again(it, "robots", "homework", "ada", catalogue["arm"]))
        [mine] = variants_of(class_, "ada", catalogue)
        replies = [
            class_.ask("GET", f"/v1/exercises/arm?{PLACE}"),
            class_.ask("GET", f"/v1/exercises/arm/figure.svg?{PLACE}"),
            class_.ask("POST", f"/v1/exercises/arm/grade?{PLACE}", answers={"table": "1"}),
            class_.ask("POST", HAND_IN, "ada", "k", exercise="arm", answers={"table": "1"}),
        ]
        for reply in replies:
            assert reply.status_code == 422
            assert "cannot be made" in reply.json()["detail"]
        # The other exercise of the assignment is there as ever.
        replies.append(class_.ask("GET", "/v1/me"))
        assert replies[-1].status_code == 200
        assert all(mine.seed not in reply.text for reply in replies)
        logged = [each.getMessage() + str(each.exc_info) for each in caplog.records]
        assert all(mine.seed not in each for each in logged)


def test_a_seed_of_the_learner_s_choice_is_refused_where_it_counts(class_: Class) -> None:
    assign(class_)
    body = {"exercise": "arm~mine", "answers": {"table": "1"}}
    assert class_.ask("POST", HAND_IN, "ada", "k", **body).status_code == 404
    new = NewAssignment.model_validate(
        {"id": "x", "title": "X", "exercises": [{"exercise": "arm~1", "points": 1}]}
    )
    with pytest.raises(CourseError, match="There is no exercise arm~1"):
        class_.do(lambda it: add_assignment(it, "robots", new, {"arm", "scara"}))


def test_practice_is_closed_for_all_variants(class_: Class) -> None:
    assign(class_, practice="none")
    paths = [
        "/v1/exercises/arm/grade",
        "/v1/exercises/arm~7/grade",
        f"/v1/exercises/arm/grade?{PLACE}",
    ]
    for path in paths:
        answer = class_.ask("POST", path, answers={})
        assert answer.json()["type"].endswith("no-practice")
    many = {"submissions": [{"exercise": "arm~7", "answers": {}}]}
    [result] = class_.ask("POST", "/v1/grade", **many).json()["results"]
    assert result["problem"]["type"].endswith("no-practice")


def test_an_assignment_without_variants_has_the_same_exercise_for_all(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_, variants=False)
    assert variants_of(class_, "ada", catalogue) == []
    told = class_.ask("GET", f"/v1/exercises/arm?{PLACE}").json()
    assert told["statement"] == catalogue["arm"].statement
    scara = class_.ask("GET", f"/v1/exercises/scara?{PLACE}").json()
    assert scara["title"] == catalogue["scara"].title


def test_a_change_of_an_assignment_keeps_the_variants(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_)
    before = variants_of(class_, "ada", catalogue)
    change = AssignmentChange.model_validate({"title": "New", "variants": True})
    changed = class_.do(lambda it: change_assignment(it, "robots", "homework", change, {"arm"}))
    assert changed.variants
    assert variants_of(class_, "ada", catalogue) == before


LONGER = VARY.replace("[0.3, 0.4, 0.5]", "[0.3, 0.4, 0.5, 0.55, 0.6]")


def test_a_corrected_file_changes_no_variant_until_a_tutor_renews_them(class_: Class) -> None:
    old, new = {"arm": varied()}, {"arm": varied(LONGER)}
    learners = [f"learner {i}" for i in range(12)]

    def statement(learner: str, exercise: Exercise) -> str:
        _, own = class_.do(lambda it: assigned(it, "robots", "homework", learner, exercise))
        return str(own.statement)

    def seen(catalogue: Mapping[str, Exercise]) -> list[str]:
        return [statement(learner, catalogue["arm"]) for learner in learners]

    people = [NewLearner(learner=each, name=each) for each in learners]
    class_.do(lambda it: roll.add_learners(it, "robots", people))
    assign(class_)
    before, without = seen(old), seen(new)
    assert before != without, "the new choices give other numbers"
    class_.do(lambda it: pin_choices(it, "robots", "homework", old))
    assert seen(new) == before
    # A later change of the assignment keeps them.
    class_.do(lambda it: pin_choices(it, "robots", "homework", new))
    assert seen(new) == before
    # The secret is random, so the new choices may give some learners the same numbers.
    other = next(i for i, each in enumerate(before) if each != without[i])
    [told] = variants_of(class_, learners[other], new)
    [plain] = variants_of(class_, learners[other], old)
    numbers = re.findall(r"(\d\.\d+) m", before[other])
    assert told.values is not None
    assert [told.values["a1"], told.values["a2"]] == numbers[:2]
    assert plain.values is None
    class_.do(lambda it: pin_choices(it, "robots", "homework", new, renew=True))
    assert seen(new) == without


def test_a_tutor_renews_the_variants_over_http(class_: Class) -> None:
    assign(class_)

    def change(catalogue: Mapping[str, Exercise], **fields: Any) -> str:
        access = Access(OPEN_HERE, read_attempts=None)
        app = application(catalogue, access=access, store=class_.store)

        async def sent() -> httpx.Response:
            local = httpx.ASGITransport(app)
            async with httpx.AsyncClient(transport=local, base_url="http://127.0.0.1") as client:
                return await client.post(
                    "/v1/courses/robots/assignments/homework", json={"title": "T", **fields}
                )

        assert asyncio.run(sent()).status_code == 200
        return str(class_.do(lambda it: it.scalar(select(assignments.c.choices))))

    old, new = {"arm": varied()}, {"arm": varied(LONGER)}
    assert "0.55" not in change(old)
    assert "0.55" not in change(new)
    assert "0.55" in change(new, renew_variants=True)


def test_a_tutor_deals_another_variant(class_: Class, catalogue: Mapping[str, Exercise]) -> None:
    assign(class_)
    arm = varied(VARY + f"deployed = {DEPLOYED[:2]}")
    seen = [variants_of(class_, "ada", {"arm": arm})[0].seed]
    for _ in range(4):
        dealt = class_.do(lambda it: deal_again(it, "robots", "homework", "ada", arm))
        assert variants_of(class_, "ada", {"arm": arm}) == [dealt]
        seen.append(dealt.seed)
    assert set(seen) == set(DEPLOYED[:2])
    assert all(one != other for one, other in pairwise(seen))
    assert variants_of(class_, "grace", {"arm": arm})[0].deals == 1
    only = varied(VARY + 'deployed = ["one"]')
    with pytest.raises(CourseError, match="no other deployed variant"):
        class_.do(lambda it: deal_again(it, "robots", "homework", "ada", only))
    with pytest.raises(CourseError, match="has no variants of scara"):
        class_.do(lambda it: deal_again(it, "robots", "homework", "ada", catalogue["scara"]))
    class_.do(lambda it: forget(it, "ada"))
    assert class_.do(lambda it: it.scalar(select(func.count()).select_from(deals))) == 0


def hand_in_right(class_: Class, catalogue: Mapping[str, Exercise], learner: str) -> str:
    [mine] = variants_of(class_, learner, catalogue)
    answers = {"table": {"rows": rows_of(catalogue["arm"], mine.seed)}}
    class_.ask("POST", HAND_IN, learner, f"key {learner}", exercise="arm", answers=answers)
    return str(mine.seed)


@pytest.mark.long
def test_tutors_see_variants_in_lists_exports_and_statistics(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_)
    seeds = {learner: hand_in_right(class_, catalogue, learner) for learner in ("ada", "grace")}

    def exported(connection: Any) -> list[Any]:
        graded = graded_attempts(connection, AttemptFilter("arm"), lambda _: "best")
        return [json.loads(each) for each in written(graded, GradesFormat.JSONL, "")]

    found = class_.do(exported)
    assert {each["learner"]: each["variant"] for each in found} == seeds
    assert {each["exercise"] for each in found} == {"arm"}
    for exercise, count in (("arm", 2), (f"arm~{seeds['ada']}", 1), ("arm~other", 0)):
        wanted = AttemptFilter(exercise)
        figures = class_.do(lambda it: exercise_statistics(it, wanted))  # noqa: B023
        assert (figures.attempts, len(figures.parts)) == (count, min(count, 1))


def test_a_regrade_grades_each_attempt_by_its_variant(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_)
    for learner in ("ada", "grace"):
        hand_in_right(class_, catalogue, learner)
    regrading = Regrading(catalogue["arm"], FeedbackLevel.FULL)
    with class_.store.engine.connect() as connection:
        assert regrading.outdated(connection) == []
    # The file has other choices now, but the assignment keeps the earlier ones.
    other = varied(
        VARY.replace("a1 = [0.3, 0.4, 0.5]", "a1 = [0.8, 0.9]").replace("<= 0.8", "<= 2")
    )
    changed = Regrading(other, FeedbackLevel.FULL)
    with class_.store.engine.connect() as connection:
        numbers = changed.outdated(connection)
        assert len(numbers) == 2
        assert [each.after for each in changed.preview(connection, numbers)] == [8, 8]
    # If the variants are renewed, the attempts at the earlier ones stay as they are.
    kept = class_.do(lambda it: it.scalar(select(assignments.c.choices)))
    class_.do(lambda it: pin_choices(it, "robots", "homework", {"arm": other}, renew=True))
    with class_.store.engine.connect() as connection:
        assert changed.preview(connection, numbers) == []
    assert regraded(class_.store, changed) == []
    class_.do(lambda it: it.execute(update(assignments).values(choices=kept)))
    # The last twist is corrected; the values of the variants are the same.
    corrected = varied(more="10deg + ")
    assert corrected.vary is not None
    regrading = Regrading(corrected, FeedbackLevel.FULL)
    done = regraded(class_.store, regrading)
    assert [(each.before, each.after < 8) for each in done] == [(8, True), (8, True)]
    with class_.store.engine.connect() as connection:
        assert regrading.outdated(connection) == []
        rows = connection.execute(select(attempts.c.version, attempts.c.report)).all()
    assert all(row.version.startswith(corrected.vary.base_version) for row in rows)
    assert {json.loads(row.report)["exercise"] for row in rows} == {"arm"}


def test_the_tutor_s_routes_show_and_deal_variants(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    assign(class_)
    path = "/v1/courses/robots/assignments/homework/variants"
    assert class_.ask("GET", f"{path}?learner=ada").status_code == 403
    assert class_.ask("POST", path, learner="ada", exercise="arm").status_code == 403


def test_an_attempt_in_practice_names_its_public_seed(
    class_: Class, catalogue: Mapping[str, Exercise]
) -> None:
    open_to_all = Class(class_.store, class_.keys, application(catalogue, store=class_.store))
    answers = {"table": {"rows": rows_of(catalogue["arm"], "k7")}}
    path = "/v1/exercises/arm~k7/attempts"
    recorded = open_to_all.ask("POST", path, learner="bo", answers=answers).json()
    assert recorded["attempt"]["exercise"] == "arm"
    assert recorded["report"]["exercise"] == "arm~k7"
    assert recorded["report"]["points"] == 8
    [row] = class_.do(lambda it: it.execute(select(attempts.c.exercise, attempts.c.variant)).all())
    assert tuple(row) == ("arm", "k7")
    figures = class_.do(lambda it: exercise_statistics(it, AttemptFilter("arm")))
    assert (figures.attempts, len(figures.parts)) == (1, 1)
