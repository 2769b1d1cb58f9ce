from hashlib import sha256

from dh_grader.learning import SlipDraws


def test_a_draw_is_the_beginning_of_a_digest_as_a_fraction() -> None:
    draws = SlipDraws("a text")
    for block in (0, 1, 2):
        number = int(sha256(f"a text\n{block}".encode()).hexdigest()[:16], 16)
        assert draws.below(1000) == number * 1000 // 2**64


def test_draws_are_the_same_everywhere() -> None:
    draws = SlipDraws("seed")
    assert [draws.below(100) for _ in range(5)] == [75, 30, 28, 66, 79]
    # 75 % of six is the fifth, 30 % of the other five the second, and so on.
    assert SlipDraws("seed").shuffled("abcdef") == list("ebcdfa")


def test_every_value_is_shuffled_once() -> None:
    assert sorted(SlipDraws("other").shuffled(range(20))) == list(range(20))
