"""Convert a user's roles in a launch to one LtiRole."""

# Roles are compared by their full URIs.

from collections.abc import Collection
from enum import Enum
from typing import Final

_VOCABULARY: Final = "http://purl.imsglobal.org/vocab/lis/v2/"
_MEMBER: Final = f"{_VOCABULARY}membership"
_TEST_USER: Final = "http://purl.imsglobal.org/vocab/lti/system/person#TestUser"
# Teachers of an institution are no tutors of each of its courses; its administrators are.
_TUTORS: Final = frozenset(
    {
        f"{_MEMBER}#Instructor",
        f"{_MEMBER}#Administrator",
        f"{_MEMBER}#ContentDeveloper",
        f"{_VOCABULARY}institution/person#Administrator",
        f"{_VOCABULARY}system/person#Administrator",
        f"{_VOCABULARY}system/person#SysAdmin",
    }
)
# Roles of a kind: TeachingAssistant, Lecturer, Grader, …
_OF_TUTORS: Final = (f"{_MEMBER}/Instructor#", f"{_MEMBER}/ContentDeveloper#")
_LEARNER: Final = f"{_MEMBER}#Learner"
_OF_LEARNERS: Final = f"{_MEMBER}/Learner#"


class LtiRole(Enum):
    """The role of a user in a course. A preview or a guest records nothing."""

    TUTOR = "tutor"
    LEARNER = "learner"
    PREVIEW = "preview"
    GUEST = "guest"


def role_of(roles: Collection[str], *, has_id: bool) -> LtiRole:
    """Return the LtiRole of a user with these roles; ``has_id`` is False for anonymous users."""
    # A test user is a preview, even with the role of a learner. Mentors and observers are guests.
    if not has_id:
        return LtiRole.GUEST
    if _TEST_USER in roles:
        return LtiRole.PREVIEW
    if any(role in _TUTORS or role.startswith(_OF_TUTORS) for role in roles):
        return LtiRole.TUTOR
    if any(role == _LEARNER or role.startswith(_OF_LEARNERS) for role in roles):
        return LtiRole.LEARNER
    return LtiRole.GUEST
