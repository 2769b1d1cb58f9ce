"""The client has a working method for every route of courses."""

import io
import zipfile
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.keys import add_key
from dh_grader.client import GraderClient, RequestRefusedError
from dh_grader.contract.courses import (
    AssignmentChange,
    CourseChange,
    DealRequest,
    DeletionRequest,
    Extension,
    LearnersRequest,
    LinksRequest,
    NewAssignment,
    NewCourse,
    RemovalRequest,
    RevokeLinksRequest,
    SendAgainRequest,
)
from dh_grader.store import AttemptStore
from dh_grader.store.database import in_transaction

from tests.api.serving import served
from tests.courses.conftest import NO_TWIST

_CHOSEN = [{"exercise": "scara", "points": 10}]
SECRET = "0123456789abcdef" * 4


def administrator(database: str) -> str:
    store, text, now = AttemptStore.open(database), new_key_text(), datetime.now(UTC)
    digest, until = Secret(SECRET).key_digest(text), now + timedelta(days=1)
    in_transaction(
        store.engine, lambda it: add_key(it, "", digest, [Scope.TUTOR], None, now, until)
    )
    store.close()
    return text


@pytest.mark.long
def test_every_route_of_courses_has_a_method(tmp_path: Path) -> None:
    database = str(tmp_path / "attempts.db")
    key = administrator(database)
    new = NewAssignment.model_validate({"id": "hw", "title": "H", "exercises": _CHOSEN})
    options = {"DH_GRADER_DATABASE": database, "DH_GRADER_SECRET": SECRET}
    with served(tmp_path, **options) as server, GraderClient(server.address, key) as tutor:
        tutor.create_course(NewCourse(id="robots", title="Robots", zone="Europe/Berlin"))
        assert tutor.change_course("robots", CourseChange(title="Arms")).title == "Arms"
        assert tutor.course("robots").zone == "Europe/Berlin"
        # An id may have characters that an address reserves.
        people = tutor.add_learners("robots", LearnersRequest(csv="id,name\na/?1,Ada\nu2,Grace\n"))
        assert (people.listed, people.added) == (2, 2)
        assert people.learners == tutor.learners("robots").learners
        tutor.create_assignment("robots", new)
        later = Extension.model_validate({"learner": "a/?1", "limit": 7})
        assert tutor.extend("robots", "hw", later).extensions[0].limit == 7
        change = AssignmentChange(solution="after_due", title="Homework")
        assert tutor.change_assignment("robots", "hw", change) == tutor.assignment("robots", "hw")
        varied = {"exercise": "planar-rr-numbers", "points": 2}
        both = AssignmentChange.model_validate({"exercises": [*_CHOSEN, varied], "variants": True})
        tutor.change_assignment("robots", "hw", both)
        wanted = DealRequest(learner="a/?1", exercise="planar-rr-numbers")
        dealt = tutor.deal_variant("robots", "hw", wanted)
        assert tutor.variants("robots", "hw", "a/?1").variants == [dealt]
        assert tutor.exercise(dealt.variant).title
        tutor.change_assignment("robots", "hw", AssignmentChange(exercises=new.exercises))
        links = {each.learner: each.link for each in tutor.links("robots", LinksRequest()).links}
        with GraderClient(server.address, links["a/?1"].partition("#")[2]) as ada:
            made = ada.hand_in("robots", "hw", "scara", NO_TWIST, idempotency_key="1")
            assert made == ada.hand_in("robots", "hw", "scara", NO_TWIST, idempotency_key="1")
            own = ada.own_courses().courses
            with pytest.raises(RequestRefusedError) as refused:
                ada.assigned_solution("robots", "hw", "scara")
            assert refused.value.code == "solution-not-shown"
            past = {"due": datetime.now(UTC) - timedelta(days=1), "closes": None}
            tutor.change_assignment("robots", "hw", AssignmentChange.model_validate(past))
            assert ada.assigned_solution("robots", "hw", "scara").exercise == "scara"
        [left] = tutor.missing("robots", "hw").missing
        assert left.name == "Grace"
        seen = tutor.learner_view("robots", "a/?1").courses
        assert (
            seen[0].assignments[0].exercises[0].attempts
            == own[0].assignments[0].exercises[0].attempts
        )
        [ada_, grace] = tutor.gradebook("robots", "hw").rows
        assert ada_.points[0] == pytest.approx(ada_.total)
        assert grace.points == [None]
        workbook = tutor.gradebook_file("robots", "xlsx")
        assert "xl/workbook.xml" in zipfile.ZipFile(io.BytesIO(workbook)).namelist()
        assert tutor.gradebook_file("robots", "csv", "hw").startswith(b"learner,name,email,")
        with pytest.raises(RequestRefusedError):
            tutor.gradebook("robots", "none")
        assert tutor.scores("robots", "hw", "u2", failed=True).scores == []
        assert tutor.send_scores("robots", SendAgainRequest(assignment="hw")).queued == 0
        assert tutor.regrade("scara", course="robots").regraded == 0
        assert tutor.revoke_links("robots", RevokeLinksRequest(learners=["u2"])).revoked == 1
        removal = RemovalRequest(learner="u2", apply=True)
        assert tutor.remove_learner("robots", removal).deleted
        every = DeletionRequest(apply=True, with_attempts=True)
        assert not tutor.delete_course("robots", DeletionRequest()).deleted
        assert tutor.delete_assignment("robots", "hw", every).attempts == 1
        assert tutor.assignments("robots").assignments == []
        assert tutor.delete_course("robots", every).learners == 1
        assert tutor.courses().courses == []
