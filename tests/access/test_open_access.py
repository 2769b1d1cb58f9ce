"""Test what the setting `open` lets everybody do."""

import pytest
from dh_grader.access import OPEN_ANYWHERE, OPEN_HERE, OpenAccess, Scope, open_access

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
