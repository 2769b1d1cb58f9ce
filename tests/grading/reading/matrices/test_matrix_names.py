"""Find the link to which the name of a matrix refers."""

import pytest
from dh_grader.grading.reading.matrices import indices_of, is_changed, is_product, places_of

from tests.together import together


def places(names: str, count: int, first: int = 1) -> list[int | None]:
    numbers = range(first, first + count)
    return list(places_of([indices_of(name.strip()) for name in names.split("|")], numbers)[0])


@together(
    "names",
    [
        "A1 | A2 | A3", "A_1 | A_2 | A_3", "A_{1} | A_{2} | A_{3}", "A{1} | A{2} | A{3}",
        "A_1(q_1) | A_2(q_2) | A_3(q_3)", r"A_1(\theta_1) | A_2(\theta_2) | A_3(d_3)",
        r"{}^{0}T_{1} | {}^{1}T_{2} | {}^{2}T_{3}", "^0T_1 | ^1T_2 | ^2T_3", "T01 | T12 | T23",
        r"{}^0_1T | {}^1_2T | {}^2_3T", "T_{01} | T_{12} | T_{23}", "T_{0,1} | T_{1,2} | T_{2,3}",
        "T_1^0 | T_2^1 | T_3^2", r"\mathbf{A}^0_1 | \mathbf{A}^1_2 | \mathbf{A}^2_3",
        "A(:,:,1) | A(:,:,2) | A(:,:,3)", "T0_1 | T1_2 | T2_3", "Link 1 | Link 2 | Link 3",
        "A[0] | A[1] | A[2]", "A0 | A1 | A2", "T_1 | T_2 | T_e", "A1 | A2 | An", "A1 | A2 | Ae",
        "T01 | T12 | T_{2,tool}", "T01 | T02 | T03", "T12 | T23 | T34", "H10 | H21 | H32",
    ],
)  # fmt: skip
def test_three_names_mean_the_links_in_order(names: str) -> None:
    assert places(names, 3) == [1, 2, 3]


@pytest.mark.parametrize(
    ("names", "count", "expected"),
    [
        ("A3 | A1 | A2", 3, [3, 1, 2]),
        ("T12 | T01", 2, [2, 1]),
        ("A1 | A2 | T", 2, [1, 2, None]),
        ("A1 | A2 | T_{02}", 2, [1, 2, None]),
        ("T01 | T12 | T02", 2, [1, 2, None]),
        ("T01 | T12 | T23 | T03", 3, [1, 2, 3, None]),
        ("A1 | A1", 2, [1, 1]),
        ("A1 | A7", 2, [1, None]),
        ("A11 | A12", 12, [11, 12]),
        ("T01 | T89 | T910", 10, [1, 9, 10]),
        ("T_{910} | T_{1011} | T_{1112}", 12, [10, 11, 12]),
        ("H10 | H109", 10, [1, 10]),
        ("T01 | T12 | T100", 10, [1, 2, None]),
        ("A1 | A3", 3, [1, 3]),
        ("ans | ans", 2, [None, None]),
        ("A1*A2*A3", 3, [None]),
    ],
)
def test_names_mean_these_places(names: str, count: int, expected: list[int | None]) -> None:
    assert places(names, count) == expected


@together(
    "names",
    [
        "A4 | A5 | A6", "T34 | T45 | T56", "T_4^3 | T_5^4 | T_6^5", "{}^3T_4 | {}^4T_5 | {}^5T_6",
        "T_{3,4} | T_{4,5} | T_{5,tool}", "A4 | A5 | Ae", "A1 | A2 | A3", "T01 | T12 | T23",
        "A0 | A1 | A2", "A1 | A2 | An",
    ],
)  # fmt: skip
def test_names_of_a_wrist_count_by_its_joints_or_from_one(names: str) -> None:
    assert places(names, 3, first=4) == [1, 2, 3]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("A2 | A3 | A4", [1, 2, 3]),
        ("A2 | A3", [1, 2]),
        ("A3 | A4", [2, 3]),
        ("A1 | A2", [1, 2]),
        ("A3 | A2 | A1", [3, 2, 1]),
        ("A4 | A1", [3, None]),
        ("A4 | A4", [3, 3]),
        ("T12 | T23 | T34", [1, 2, 3]),
        ("T12 | T23", [1, 2]),
        ("T01 | T12", [1, 2]),
    ],
)
def test_the_robots_own_numbers_come_first(names: str, expected: list[int | None]) -> None:
    assert places(names, 3, first=2) == expected


def test_names_may_count_from_zero_or_from_one() -> None:
    def unusual(*names: str) -> str:
        return places_of([indices_of(name) for name in names], range(1, len(names) + 1))[1]

    assert unusual("A0", "A1")
    assert not unusual("A1", "A2")
    assert not unusual("T01", "T12")


@pytest.mark.parametrize(
    "name", ["inv(A1)", "A1'", "A1.T", "A1inv", "A_1^T", "A_1^{-1}", "A_1^{T}", r"A_1^\top"]
)
def test_names_of_inverses_and_transposes(name: str) -> None:
    assert is_changed(name)


@pytest.mark.parametrize(
    "name", ["A1", "^0T_1", "{}^{0}T_{1}", "{}^T_2 T", r"A_1(\theta_1)", "T_1^0", "Link 2", "A1.m"]
)
def test_names_of_links(name: str) -> None:
    assert not is_changed(name)
    assert not is_product(name)


@pytest.mark.parametrize("name", ["A1*A2", "A_1 A_2", "A1 @ A2", r"A_1 \cdot A_2", "A1A2"])
def test_names_of_products(name: str) -> None:
    assert is_product(name)
