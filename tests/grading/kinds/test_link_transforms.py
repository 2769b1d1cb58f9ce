"""Grade link transforms, also in the frames of the student's own table."""

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.scara import (
    A1,
    A3,
    A4,
    IDENTITY,
    LINKS,
    SCARA,
    TABLE,
    a2_with,
    graded,
    table,
    wrong_cells,
)


@pytest.fixture
def scara(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(SCARA)


def test_the_printed_link_transforms_are_right(scara: Exercise) -> None:
    parts = graded(scara, table=table(TABLE), links=LINKS)
    assert parts["links"].verdict is Verdict.CORRECT
    assert parts["links"].points == 8
    assert not parts["links"].follow_through
    assert [row.label for row in parts["links"].rows][:5] == [
        "A1.1",
        "A1.2",
        "A1.3",
        "A1.4",
        "A2.1",
    ]


def test_links_are_graded_in_the_frames_of_the_table(scara: Exercise) -> None:
    # The student's z2 points up, so that α2 is 0, α3 is 180°, and row 3 has −d3.
    own = [TABLE[0], ("a2", "0", "0", "q2"), ("0", "pi", "-d3", "0"), TABLE[3]]
    own_links = [
        A1,
        [["c2", "-s2", "0", "a2*c2"], ["s2", "c2", "0", "a2*s2"], *A1[2:]],
        [list("1000"), ["0", "-1", "0", "0"], ["0", "0", "-1", "-d3"], list("0001")],
        A4,
    ]
    assert graded(scara, table=table(own), links=own_links)["links"].points == 8
    assert graded(scara, links=own_links)["links"].points == 8
    in_other_frames = graded(scara, table=table(own), links=LINKS)["links"]
    assert in_other_frames.points < 8
    assert {row.split(".")[0] for row, _ in wrong_cells(in_other_frames)} == {"A2", "A3"}


def test_without_a_table_a_wrong_matrix_is_named(scara: Exercise) -> None:
    part = graded(scara, links=[A1, a2_with("a1"), A3, A4])["links"]
    assert wrong_cells(part) == {("A2.1", "4"), ("A2.2", "4")}


def test_an_omitted_matrix_is_missing_and_others_are_graded(scara: Exercise) -> None:
    part = graded(scara, table=table(TABLE), links=LINKS[:3])["links"]
    assert {row for row, _ in wrong_cells(part)} == {"A4.1", "A4.2", "A4.3", "A4.4"}
    # The entries that differ from the joint's motion: 2 of A1, 5 of A2, 0 of A3 and 1 of A4. With a
    # fifth for each matrix these are 8.8 units of 0.91 points; 8 - 8 * 0.91 = 4 * 0.18 are left.
    assert part.points == pytest.approx(8 - (0.91 + 0.18))


@pytest.mark.parametrize(
    "long", [[*A4, list("0000")], [list("0000")] * 40, [list("00000")] * 4, [], None, 5, {}]
)
def test_a_matrix_of_the_wrong_size_affects_only_itself(scara: Exercise, long: object) -> None:
    part = graded(scara, table=table(TABLE), links=[*LINKS[:3], long])["links"]
    assert {row for row, _ in wrong_cells(part)} == {"A4.1", "A4.2", "A4.3", "A4.4"}
    # As without the fourth matrix.
    assert part.points == pytest.approx(8 - (0.91 + 0.18))


@pytest.mark.parametrize("answer", [5, "x", {}, [5], [[["1"]] * 9], [IDENTITY] * 5, [[]], [5] * 4])
def test_an_answer_without_matrices_is_unreadable(scara: Exercise, answer: object) -> None:
    part = graded(scara, links=answer)["links"]
    assert part.verdict is Verdict.UNREADABLE
    assert part.points == 0


@pytest.mark.parametrize("first", ["0", "", None])
def test_links_that_no_joint_moves_earn_nothing_with_an_empty_entry(
    catalogue: Mapping[str, Exercise], first: str | None
) -> None:
    # The third row of a standard link is (0, sin α, cos α, d); α is -90°, 90°, 0, -90°, 90°, 0.
    thirds = [(-1, 0), (1, 0), (0, 1)] * 2
    links: list[Any] = [
        [[0] * 4, [0] * 4, [0, sine, cosine, 0], [0, 0, 0, 1]] for sine, cosine in thirds
    ]
    report = graded(
        catalogue["stanford-arm"], links=[[[first, 0, 0, 0], *links[0][1:]], *links[1:]]
    )
    assert "no_joint_variable" in {message.code for message in report["links"].feedback}
    assert report["links"].points == 0
