"""Test the misconceptions about a product of link transforms."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from dh_grader.grading.diagnosis import motions as link_products
from dh_grader.grading.diagnosis.motions import Chain, LinkPose, named
from dh_grader.grading.misconception import Written
from dh_grader.grading.report import Finding
from dh_grader.kinematics import Numbers
from dh_grader.translations import say

from tests.grading.diagnosis.example_chain import A1, A2, A3, A4, CHAIN, POSE, X, Z, product
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair


@dataclass(frozen=True)
class WrongPose:
    """A wrong pose; the correct pose is ``POSE``."""

    actual: Numbers

    def explained_by(self, hypotheses: Iterable[LinkPose]) -> list[LinkPose]:
        return [each for each in hypotheses if np.allclose(each.answer, self.actual)]


def chain(_case: WrongPose) -> Chain:
    return CHAIN


MODIFIED = [x @ z for z, x in zip(Z, X, strict=True)]
PAIRS = [
    Pair(function, WrongPose(explained), WrongPose(unexplained), source=chain)
    for function, explained, unexplained in (
        (link_products.reversed_product, product(A4, A3, A2, A1), product(A4, A3, A1, A2)),
        (link_products.other_convention, product(*MODIFIED), product(A1, *MODIFIED[1:])),
        (link_products.wrong_frame, product(A1, A2), A2),
        (link_products.wrong_base, product(A3, A4), A3),
        (link_products.missing_link, product(A1, A2, A4), product(A1, A2, A3)),
        (link_products.premultiplied, product(A3, A1, A2, A4), product(A1, A3, A2, A4)),
        (link_products.row_order, product(A2, A3, A1, A4), product(A2, A1, A3, A4)),
    )
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert not np.allclose(pair.explained.actual, POSE)
    assert_explains_only_the_first(pair)


def test_all_links_multiplied_from_the_left_are_explained() -> None:
    poses = [pose.answer for pose in link_products.premultiplied(CHAIN)]
    assert np.allclose(poses[-1], product(*MODIFIED[::-1]))


def test_the_name_of_a_pose_is_put_into_a_sentence() -> None:
    hint = say("{pose}. {advice}", pose="the pose of frame {2}", advice="Go on.")
    pose = Written(POSE, Finding("wrong_frame", hint))
    [other, finding] = named(pose, "This matrix is {pose}. {advice}", Finding("sign", "Wrong."))()
    assert other.hint == "Wrong."
    assert finding.hint == "This matrix is the pose of frame {2}. Go on."
