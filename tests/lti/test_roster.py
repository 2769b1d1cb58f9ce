"""Read class lists (rosters) from platforms."""

from typing import Any

import jwt
import pytest
from dh_grader.contract.courses import NewLearner
from dh_grader.courses.roll import add_learners
from dh_grader.lti import roster as roster_members
from dh_grader.store.tables import contexts, course_learners
from sqlalchemy import select

from tests.lti.conftest import Tool, hidden, token_of
from tests.lti.platform import MEMBER, TEST_USER

KINDS = pytest.mark.parametrize("tool", ["sqlite", "postgresql"], indirect=True)


def member(number: int, **more: Any) -> dict[str, Any]:
    roles = [f"{MEMBER}#Learner"]
    name, email = f"Person {number}", f"p{number}@secret.example"
    user = {"user_id": f"user {number}", "name": name, "email": email, "roles": roles}
    return {"status": "Active", **user, **more}


class Reader:
    """A tutor who has opened the course and reads its roster."""

    def __init__(self, tool: Tool) -> None:
        self.tool = tool
        ticket = hidden(tool.launch("turing").text, "ticket")
        opened = tool.send("POST", "/lti/session", data={"ticket": ticket})
        self.headers = {"cookie": opened.headers["set-cookie"].partition(";")[0]}
        self.path = opened.headers["location"].removeprefix("..").partition("?")[0]
        self.course = self.path.rpartition("/")[2]

    def read(self, **fields: str) -> str:
        page = self.tool.send("POST", f"{self.path}/roster", data=fields, headers=self.headers)
        return page.text.partition("<main")[2]

    def names(self) -> dict[str, str]:
        of = course_learners.c
        chosen = select(of.learner, of.name).where(of.course == self.course)
        rows = self.tool.do(lambda it: it.execute(chosen).all())
        return {row.learner: row.name for row in rows}


@pytest.mark.long
def test_a_roster_of_1200_comes_in_pages(tool: Tool) -> None:
    reader, platform = Reader(tool), tool.platform
    assert "Read the roster" in tool.send("GET", reader.path, headers=reader.headers).text
    platform.members = [member(i) for i in range(1200)]
    assert "1200 learners: 1200 new, 0 removed, 0 renamed" in reader.read()
    assert platform.fetched[-24:] == [f"/members?page={i}" for i in range(24)]
    names = reader.names()
    assert len(names) == 1200
    assert names == {learner: f"Learner {learner[-6:]}" for learner in names}
    # The assertion with which the token was asked for is signed with our published key.
    keys = jwt.PyJWKSet.from_dict(tool.send("GET", "/lti/jwks.json").json())
    text = platform.asked[-1]["client_assertion"]
    key = keys[jwt.get_unverified_header(text)["kid"]]
    jwt.decode(text, key, ["RS256"], audience=f"{platform.address}/token")


@KINDS
def test_learners_are_renamed_removed_and_come_back(tool: Tool) -> None:
    tool.launch("ada")
    reader, platform = Reader(tool), tool.platform
    [ada] = reader.names()
    by_hand = [NewLearner(learner="by-hand", name="By Hand")]
    tool.do(lambda it: add_learners(it, reader.course, by_hand))
    me = member(0, user_id="user ada", name="Ada  King\u202e", status="Active")
    platform.members = [me, *(member(i) for i in range(1, 4))]
    assert "4 learners: 3 new, 0 removed, 1 renamed" in reader.read(names="on")
    names = reader.names()
    assert names[ada].startswith("Ada King")
    assert "\u202e" not in names[ada]
    assert set(names.values()) >= {"Person 1", "Person 2", "Person 3", "By Hand"}
    assert "secret" not in str(names)
    # One is renamed, one inactive, one deleted, one not there any more.
    platform.members = [
        {**me, "name": "Ada Lovelace"},
        member(1, status="Inactive"),
        member(2, status="Deleted"),
    ]
    assert "1 learner: 0 new, 3 removed, 1 renamed" in reader.read(names="on")
    assert reader.names() == {ada: "Ada Lovelace", "by-hand": "By Hand"}
    # Without names again; and a removed learner who launches is there again.
    reader.read()
    assert reader.names()[ada] == f"Learner {ada[-6:]}"
    platform.members = [member(1)]
    reader.read()
    assert ada not in reader.names()
    assert token_of(tool.launch("ada").text)
    assert ada in reader.names()
    [context] = tool.do(lambda it: it.execute(select(contexts)).all())
    assert (context.shows_names, context.roster_at is None) == (False, False)


def test_only_learners_are_enrolled(tool: Tool) -> None:
    reader = Reader(tool)
    tool.platform.members = [
        member(1),
        member(2, roles=[f"{MEMBER}#Instructor"]),
        member(3, roles=[f"{MEMBER}#Mentor"]),
        member(4, roles=[f"{MEMBER}#Learner", TEST_USER]),
        member(5, roles="Learner"),
        member(6, user_id=6),
        member(7, user_id=""),
        member(8, roles=["Learner"]),
        {"nothing": True},
    ]
    assert "2 learners: 2 new" in reader.read()


@pytest.mark.long
def test_an_unusable_roster_changes_nothing(tool: Tool, monkeypatch: pytest.MonkeyPatch) -> None:
    reader, platform = Reader(tool), tool.platform
    platform.members = [member(i) for i in range(120)]
    reader.read()
    before = reader.names()
    platform.next_page = "https://evil.example/members?page=1"
    assert "next page is at another host" in reader.read()
    platform.next_page = f"{platform.address}/members?page=0"
    monkeypatch.setattr(roster_members, "MOST_PAGES", 5)
    assert "more than 5 pages" in reader.read()
    monkeypatch.setattr(roster_members, "LARGEST_PAGE", 2048)
    assert "larger than 2 KiB" in reader.read()
    monkeypatch.undo()
    platform.members, platform.next_page = [], ""
    assert "has no learner. Nothing was changed" in reader.read()
    assert reader.names() == before
    # Without a session, nobody reads a roster.
    assert tool.send("POST", f"{reader.path}/roster").status_code in (401, 403)
