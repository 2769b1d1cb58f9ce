from hashlib import sha256

from dh_grader.variants.robot_geometry import Draws


def test_draws_are_the_words_of_a_hash() -> None:
    block = sha256(b"a robot\n0").digest()
    words = [int.from_bytes(block[i : i + 4], "big") for i in range(0, 32, 4)]
    draws = Draws("a robot")
    assert [draws.below(1000) for _ in words] == [word * 1000 // 2**32 for word in words]


def test_choices_follow_their_weights() -> None:
    draws = Draws("weights")
    found = [draws.weighted([("a", 3), ("b", 0), ("c", 1)]) for _ in range(4000)]
    assert "b" not in found
    assert 2850 < found.count("a") < 3150
    assert 350 < sum(draws.chance(10) for _ in range(4000)) < 450
