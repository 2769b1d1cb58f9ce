"""Test callers, keys and tokens."""

import base64
import hmac
import json
import random
import re
import time
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Final
from zlib import crc32

import pytest
from dh_grader.access import (
    NOBODY,
    OPEN_ANYWHERE,
    OPEN_HERE,
    Caller,
    CredentialError,
    Key,
    OpenAccess,
    Scope,
    Secret,
    client_key,
    is_spelt_right,
    key_text_of,
    new_key_text,
    open_access,
)
from dh_grader.access.key_ring import LearnerToken, key_of_session, signed, signed_session, verified
from dh_grader.settings import SettingsError, load_settings

# --- Test what a caller may reach, and whose requests and attempts are one client's

LEARNER = Caller(frozenset(), learner="ada", key_id="0011aaff")


@pytest.mark.parametrize(
    ("exercises", "named", "reaches"),
    [
        (None, "scara", True),
        (["scara"], "scara", True),
        (["scara"], "scara~k7", True),
        (["scara"], "scara~k7~k8", True),
        (["scara", "puma"], "puma~k7", True),
        (["scara"], "puma", False),
        (["scara"], "puma~scara", False),
        (["scara"], "scara-2~k7", False),
        (["scara"], "~scara", False),
        ([], "scara", False),
    ],
)
def test_a_caller_reaches_exercises_and_their_variants(
    exercises: list[str] | None, named: str, reaches: bool
) -> None:
    only = None if exercises is None else frozenset(exercises)
    assert Caller(frozenset(), only).reaches(named) is reaches


@pytest.mark.parametrize(
    ("exercises", "course", "reaches_all"),
    [
        (None, None, True), (frozenset({"scara"}), None, False),
        (None, "robots", False), (frozenset({"scara"}), "robots", False),
    ],
)  # fmt: skip
def test_a_caller_with_a_course_or_exercises_does_not_reach_all(
    exercises: frozenset[str] | None, course: str | None, reaches_all: bool
) -> None:
    assert Caller(frozenset(), exercises, course=course).reaches_all is reaches_all


def test_the_owner_is_a_key_or_one_learner() -> None:
    assert NOBODY.owner == ""
    assert Caller(frozenset(), key_id="0011aaff").owner == "0011aaff"
    others = (
        Caller(frozenset(), learner="grace", key_id="0011aaff"),
        Caller(frozenset(), learner="ada", key_id="0011aaee"),
        Caller(frozenset(), learner="ada", key_id="0011aaff", course="robots"),
        Caller(frozenset(), learner="ada", key_id="0011aaff", course="others"),
    )
    owners = [LEARNER.owner, *(each.owner for each in others)]
    assert len(set(owners)) == len(owners)
    # The column for it has 32 characters.
    assert {len(each) for each in owners} == {32}
    # A renewed personal link has another key.
    renewed = Caller(frozenset(), learner="ada", key_id="0011aaee", course="robots")
    assert renewed.owner == others[2].owner


# --- Test what the setting `open` lets everybody do

GRADE, RECORD = frozenset({Scope.GRADE}), frozenset({Scope.GRADE, Scope.RECORD})


@pytest.mark.parametrize(
    ("text", "scopes", "until_keys", "anywhere"),
    [
        # Nothing is set: open until there are keys, on this machine only.
        (None, frozenset(), True, False),
        ("until-keys", frozenset(), True, True),
        ("none", frozenset(), False, True),
        ("grade", GRADE, False, True),
        # Whoever may record may have answers graded.
        ("record", RECORD, False, True),
        ("grade,record", RECORD, False, True),
        (" record , grade ", RECORD, False, True),
    ],
)
def test_the_setting_opens_these_scopes(
    text: str | None, scopes: frozenset[Scope], until_keys: bool, anywhere: bool
) -> None:
    assert open_access(text) == OpenAccess(scopes, until_keys, anywhere)


def test_a_service_is_open_until_there_are_keys() -> None:
    assert OpenAccess() == OpenAccess(frozenset(), until_keys=True, anywhere=False) == OPEN_HERE
    assert OpenAccess(frozenset(), until_keys=True, anywhere=True) == OPEN_ANYWHERE


@pytest.mark.parametrize("text", ["", "tutor", "grade,tutor", "grade;record", "all", "None"])
def test_nobody_becomes_a_tutor_by_a_setting(text: str) -> None:
    words = "write until-keys, none, or what needs no key: grade, or grade,record"
    with pytest.raises(ValueError, match=words):
        open_access(text)


# --- Identify a client by the address of its requests


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("10.0.0.1", "10.0.0.2", False),
        ("2001:db8:1:2::1", "2001:db8:1:2:ffff::9", True),
        ("2001:db8:1:2::1", "2001:db8:1:3::1", False),
        ("fe80::1%eth0", "fe80::2%eth0", True),
        ("::ffff:10.0.0.1", "10.0.0.1", True),
        ("::ffff:10.0.0.1", "::ffff:10.0.0.2", False),
        ("testclient", "testclient", True),
        ("no:address", "no:other", False),
    ],
)
def test_the_addresses_of_an_ipv6_network_are_one_client(one: str, other: str, same: bool) -> None:
    assert (client_key(one) == client_key(other)) is same


@pytest.mark.parametrize(
    ("address", "client"),
    [
        ("10.0.0.1", "10.0.0.1"), ("2001:db8:1:2:3::4%eth0", "2001:db8:1:2::/64"),
        ("::ffff:10.0.0.1", "10.0.0.1"), ("no:address", "no:address"), ("", ""),
    ],
)  # fmt: skip
def test_a_client_is_named_by_its_address_or_network(address: str, client: str) -> None:
    assert client_key(address) == client


# --- Test the text of an API key: its characters and its checksum

DIGITS = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"


def test_a_key_is_random_and_spelt_right() -> None:
    keys = {new_key_text() for _ in range(100)}
    assert len(keys) == 100
    assert all(re.fullmatch(r"dhg_[0-9A-Za-z]{38}", key) for key in keys)
    assert all(map(is_spelt_right, keys))


def written(number: int, length: int) -> str:
    """Write a number in base 62, the lowest digit first."""
    return "".join(DIGITS[number // 62**i % 62] for i in range(length))


@pytest.mark.parametrize("number", [0, 1 + 2 * 62 + 61 * 62**2, 62**32 - 1, 62**32 + 7, 2**512 - 1])
def test_the_text_of_a_personal_link_stays_the_same(number: int) -> None:
    drawn = written(number, 32)
    text = f"dhg_{drawn}{written(crc32(drawn.encode()), 6)}"
    assert key_text_of(number.to_bytes(64, "big")) == text
    assert is_spelt_right(text)


def test_a_key_has_any_digit_and_letter() -> None:
    texts = "".join(new_key_text()[4:36] for _ in range(100))
    assert set(texts) == set(DIGITS)


def test_every_wrong_or_swapped_character_is_detected() -> None:
    key = new_key_text()
    for i in range(len(key)):
        for other in "a0Z_θ ":
            assert is_spelt_right(key[:i] + other + key[i + 1 :]) is (key[i] == other)
    swapped = [key[:i] + key[i + 1] + key[i] + key[i + 2 :] for i in range(4, len(key) - 1)]
    assert not any(is_spelt_right(each) for each in swapped if each != key)


@pytest.mark.parametrize("text", ["", "dhg_", "dhg_" + 38 * "0", 42 * "a", "a.b.c"])
def test_other_texts_are_not_keys(text: str) -> None:
    assert not is_spelt_right(text)


# --- Any signed token is either read or refused with a reason

SECRET: Final = Secret("0123456789abcdef" * 4).token_secret
HEADER: Final[Mapping[str, Any]] = {"alg": "HS256", "typ": "JWT"}
CLAIMS: Final[Mapping[str, Any]] = {
    "iss": "dh-grader",
    "sub": "ada",
    "key": "0011aaff",
    "scope": "grade record",
    "exp": int(time.time()) + 3600,
    "exercises": ["scara"],
}
# Values for each claim and each field of the header.
ODD: Final[tuple[Any, ...]] = (
    None, True, False, 0, -1, 1e300, 10**400, 10**18, "", " ", "x", "\0", "ada\0", "\ud800",
    "x" * 9000, "1", [], ["ada"], [[]], [None, 1, {}], {}, {"a": 1}, {"$ref": "#"}, [["scara"]],
    "HS256", "none", "RS256", "tutor", "grade root", "0011AAFF", "0011aaff ", "1' OR 1=1 --",
    "99999999999999999999",
)  # fmt: skip
# JSON values, valid and invalid, that json.dumps does not write.
RAW: Final = (
    b"NaN", b"Infinity", b"-Infinity", b"1e999", b"-0", b"1" * 5000, b"[" * 5000, b"nul", b"\xff",
    b'"\\ud800"', b"0x10", b"01", b"1.0", b"'x'",
)  # fmt: skip


def segment(content: bytes) -> bytes:
    return base64.urlsafe_b64encode(content).rstrip(b"=")


def token(header: bytes, claims: bytes) -> str:
    """Sign a token with the real secret (RFC 7515, 5.1), without the code under test."""
    signing_input = segment(header) + b"." + segment(claims)
    signature = hmac.digest(SECRET, signing_input, "sha256")
    return (signing_input + b"." + segment(signature)).decode()


def text(value: object) -> bytes:
    return json.dumps(value).encode()


def with_raw(fields: Mapping[str, Any], name: str, raw: bytes) -> bytes:
    return text({**fields, name: "@@"}).replace(b'"@@"', raw)


def outcome(credential: str) -> LearnerToken | str:
    try:
        return verified(credential, SECRET)
    except CredentialError as error:
        return str(error)


def test_a_signed_token_is_verified() -> None:
    told = LearnerToken("0011aaff", "ada", frozenset({Scope.RECORD}), frozenset({"scara"}))
    until = datetime.now(UTC) + timedelta(minutes=1)
    assert verified(signed(told, until, SECRET), SECRET) == told
    assert verified(token(text(HEADER), text(CLAIMS)), SECRET) == told._replace(
        scopes=frozenset({Scope.GRADE, Scope.RECORD})
    )
    assert outcome(signed(told, until - timedelta(minutes=2), SECRET)) == "The token has expired."
    assert "nor a token" in str(outcome(token(text(HEADER), text(CLAIMS))[:-2] + "AA"))


@pytest.mark.parametrize("kind", ["token", "session"])
def test_a_token_and_a_session_are_valid_until_the_second_in_which_they_expire(
    monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    until = datetime(2026, 11, 22, 12, tzinfo=UTC)
    told = LearnerToken("0011aaff", "ada", frozenset({Scope.RECORD}), None)
    text = (
        signed(told, until, SECRET)
        if kind == "token"
        else signed_session("0011aaff", until, SECRET)
    )

    def key() -> str:
        return verified(text, SECRET).key_id if kind == "token" else key_of_session(text, SECRET)

    monkeypatch.setattr(time, "time", lambda: until.timestamp() - 0.001)
    assert key() == "0011aaff"
    for moment in (until.timestamp(), until.timestamp() + 1):
        monkeypatch.setattr(time, "time", lambda moment=moment: moment)
        with pytest.raises(CredentialError, match=f"The {kind} has expired"):
            key()


@pytest.mark.parametrize("claim", [*CLAIMS, "nbf", "iat", "aud", "jti", "other", "\ud800"])
def test_an_unexpected_claim_is_refused_and_named(claim: str) -> None:
    fits: Callable[[Any], bool] = {
        "sub": lambda value: value in ("x", "1", "HS256", "none", "RS256", "tutor", "grade root",
                                       "0011AAFF", "1' OR 1=1 --", "99999999999999999999"),
        "scope": lambda value: value in ("", " ", "tutor"),
        "exp": lambda value: value in (10**400, 10**18) and not isinstance(value, float),
        "exercises": lambda value: value is None or value in ([], ["ada"]),
    }.get(claim, lambda _: False)  # fmt: skip
    named = claim if claim in CLAIMS else "others"
    for value in ODD:
        found = outcome(token(text(HEADER), text({**CLAIMS, claim: value})))
        if fits(value):
            assert isinstance(found, LearnerToken), value
        elif claim == "exp" and type(value) is int:
            assert found == "The token has expired."
        else:
            assert isinstance(found, str), value
            # A lone surrogate is not valid JSON.
            assert (named if value != "\ud800" else "others") in found, value
    for raw in RAW:
        found = outcome(token(text(HEADER), with_raw(CLAIMS, claim, raw)))
        assert isinstance(found, str) or (claim == "exp" and raw == b"1" * 5000)
    if claim in CLAIMS:
        left_out = {name: value for name, value in CLAIMS.items() if name != claim}
        found = outcome(token(text(HEADER), text(left_out)))
        assert isinstance(found, str) != (claim == "exercises")


def test_claims_that_are_not_an_object_are_refused() -> None:
    for value in ODD:
        assert isinstance(outcome(token(text(HEADER), text(value))), str)
    for raw in (*RAW, b"", b"\0", text(CLAIMS) + b"x", text(CLAIMS)[:-1], b"\xef\xbb\xbf{}"):
        assert isinstance(outcome(token(text(HEADER), raw)), str)


@pytest.mark.parametrize("field", ["alg", "typ", "kid", "crit", "b64", "zip", "jwk", "x5c", "cty"])
def test_an_unexpected_header_causes_no_exception(field: str) -> None:
    headers = [text({**HEADER, field: value}) for value in ODD]
    headers += [with_raw(HEADER, field, raw) for raw in RAW]
    headers += [text({**HEADER, "b64": False, "crit": value}) for value in ODD]
    headers += [*map(text, ODD), *RAW, b"", b"{}"]
    for header in headers:
        found = outcome(token(header, text(CLAIMS)))
        # Only one algorithm is accepted.
        if field == "alg" and isinstance(found, LearnerToken):
            assert json.loads(header)["alg"] == "HS256"


def test_a_damaged_token_is_refused() -> None:
    right = token(text(HEADER), text(CLAIMS))
    draw = random.Random(8)
    for _ in range(2000):
        spoilt = list(right)
        for _ in range(draw.randint(1, 4)):
            place = draw.randrange(len(spoilt))
            spoilt[place] = draw.choice(".=-_ \0\xff/+aZ09")
        if "".join(spoilt) != right:
            # Two bits of the last character of a signature are unused.
            found = outcome("".join(spoilt))
            assert isinstance(found, str) or spoilt[:-1] == list(right)[:-1]
    for odd in ("", ".", "..", "...", "a.b", "\xff.\xff.\xff", "." * 9000, "e30.e30."):
        assert isinstance(outcome(odd), str)


ONE, BOTH = frozenset({"scara"}), frozenset({"scara", "puma"})


@pytest.mark.parametrize(
    ("of_token", "of_key", "expected"),
    [
        (None, None, None),
        (ONE, None, ONE),
        (None, ONE, ONE),
        (BOTH, ONE, ONE),
        (ONE, BOTH, ONE),
        (frozenset({"puma"}), ONE, frozenset()),
        (frozenset(), None, frozenset()),
    ],
)
def test_a_token_has_at_most_the_exercises_and_scopes_of_its_key(
    of_token: frozenset[str] | None, of_key: frozenset[str] | None, expected: frozenset[str] | None
) -> None:
    told = LearnerToken("0011aaff", "ada", frozenset({Scope.GRADE, Scope.TUTOR}), of_token)
    for course in (None, "robots"):
        scopes = frozenset({Scope.GRADE, Scope.RECORD})
        holder = Caller(scopes, of_key, key_id="0011aaff", course=course)
        grades = frozenset({Scope.GRADE})
        assert told.caller(holder) == Caller(grades, expected, "ada", "0011aaff", course)


def test_a_key_is_valid_until_it_expires_or_is_revoked() -> None:
    now, tick = datetime(2026, 10, 1, 8, tzinfo=UTC), timedelta(microseconds=1)
    key = Key("0011aaff", "Moodle", frozenset({Scope.RECORD}), ONE, now, now, None, None, "robots")
    caller = key.caller(now - tick)
    # Every key may grade.
    scopes = frozenset({Scope.GRADE, Scope.RECORD})
    assert caller == Caller(scopes, ONE, None, "0011aaff", "robots")
    for moment in (now, now + tick):
        with pytest.raises(CredentialError, match=r"^The key has expired\.$"):
            key.caller(moment)
    revoked = Key("0011aaff", "", frozenset(), None, now, now + tick, revoked_at=now)
    with pytest.raises(CredentialError, match=r"^The key was revoked\.$"):
        revoked.caller(now)


def test_all_secrets_follow_from_one_and_differ() -> None:
    one, other = (Secret(letter * 64) for letter in "ab")

    def derived(secret: Secret) -> list[object]:
        return [
            secret.check, secret.token_secret, secret.session_secret, secret.lti_secret,
            secret.key_digest("dhg_1"), secret.key_digest("dhg_2"),
            secret.link_key("1"), secret.link_key("2"),
        ]  # fmt: skip

    assert derived(one) == derived(Secret("a" * 64))
    assert len({*derived(one), *derived(other)}) == 2 * len(derived(one))
    # What signs must not be what is stored.
    assert one.check != one.token_secret.hex()


def test_a_secret_has_at_least_32_characters(tmp_path: Path) -> None:
    # As docs/settings.md has it.
    file = tmp_path / "secret"
    for text, is_long in (("x" * 31, False), ("x" * 32, True)):
        file.write_text(f" {text}\n", encoding="utf-8")
        for option in ({"secret": text}, {"secret_file": file}):
            with nullcontext() if is_long else pytest.raises(SettingsError, match="is short"):
                secret = load_settings(**option).known_secret()
                assert secret is not None
                assert secret.check == Secret(text).check


def test_stored_keys_stay_valid() -> None:
    # RFC 2104: the secret is the key of both hashes, and the API key is a message.
    inner = hmac.new(b"s" * 64, b"dh-grader keys", "sha256").digest()
    told = hmac.new(inner, b"dhg_1", "sha256").hexdigest()
    assert Secret("s" * 64).key_digest("dhg_1") == told
