from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from dh_grader.access import Secret
from dh_grader.lti import LtiError
from dh_grader.lti.fetching import ensure_key, published_keys, rotate, signing_key
from dh_grader.store.tables import own_keys

from tests.access.kept_services import SECRET
from tests.lti.conftest import Tool

NOW = datetime.now(UTC)
DAY = timedelta(days=1)
KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)


@pytest.mark.long
@KINDS
def test_a_new_key_is_published_for_a_day_before_it_signs(tool: Tool) -> None:
    def ids() -> list[str]:
        return [each["kid"] for each in tool.do(published_keys)["keys"]]

    def signing(now: datetime) -> Any:
        return tool.do(lambda it: signing_key(it, SECRET, now)).id

    tool.do(lambda it: it.execute(own_keys.delete()))
    tool.do(lambda it: ensure_key(it, SECRET, NOW))
    [first] = ids()
    assert tool.do(lambda it: rotate(it, SECRET, NOW)) == NOW + DAY
    assert tool.do(lambda it: rotate(it, SECRET, NOW)) == NOW + DAY
    first_again, second = ids()
    assert (first_again, signing(NOW + DAY / 2)) == (first, first)
    assert signing(NOW + DAY) == second
    tool.do(lambda it: rotate(it, SECRET, NOW + 2 * DAY))
    assert ids()[0] == second
    assert len(ids()) == 2
    # Only public parts are published, and the private ones need the secret.
    assert not {"d", "p", "q"} & set(tool.do(published_keys)["keys"][0])
    other = Secret("another secret of thirty-two chars")
    with pytest.raises(LtiError):
        tool.do(lambda it: signing_key(it, other, NOW + DAY))
    shown = tool.send("GET", "/lti/jwks.json").json()["keys"]
    assert [each["kid"] for each in shown] == ids()
