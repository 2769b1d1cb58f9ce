"""Record launches (users who open a link on a learning platform), and make their pages."""

from datetime import UTC, datetime, timedelta
from typing import Final

from sqlalchemy import Connection

from dh_grader.access import Caller, Keys, Scope, Secret
from dh_grader.api.http import Catalogue
from dh_grader.api.recording import write
from dh_grader.catalogue import FeedbackLevel
from dh_grader.lti import LtiRole
from dh_grader.lti.deep_linking import begin_linking
from dh_grader.lti.fetching import PlatformThreads
from dh_grader.lti.grade_services import AccessTokens, available_key
from dh_grader.lti.handed_files import PlatformFiles
from dh_grader.lti.launch import (
    DEEP_LINKING,
    REPORT,
    SETTINGS,
    Landing,
    LaunchMessage,
    Login,
    LtiTicket,
    enter,
    pseudonym,
    signed_ticket,
    use_login,
)
from dh_grader.lti.outbox import utc_now
from dh_grader.store import AttemptStore
from dh_grader.translations import Language
from dh_grader.web.lti_pages import (
    Choice,
    Offer,
    Picked,
    ReportPages,
    choosing_page,
    landing_page,
    offer_of,
    picker_page,
    tutor_page,
)
from dh_grader.web.pages import Assets

# The lifetime of the token in a page. The page keeps it in memory; a reload needs a new launch.
TOKEN_LIFETIME: Final = timedelta(hours=12)


class Landings:
    """Records launches (users who open a link on a learning platform), and makes their pages."""

    # One transaction records a launch and marks its login as used.

    def __init__(
        self,
        catalogue: Catalogue,
        assets: Assets,
        store: AttemptStore,
        keys: Keys,
        secret: Secret,
        platforms: PlatformThreads,
        feedback: FeedbackLevel = FeedbackLevel.FULL,
    ) -> None:
        """``feedback`` is the highest feedback level for students."""
        self.catalogue, self.assets, self.store = catalogue, assets, store
        self.keys, self.secret, self.platforms = keys, secret, platforms
        self.platform_files = PlatformFiles(
            AccessTokens(utc_now, lambda: available_key(store.engine, secret, utc_now()))
        )
        self._reports = ReportPages(
            assets, store, secret, catalogue, feedback, self.platform_files, platforms
        )

    async def page(self, message: LaunchMessage, login: Login, language: Language) -> bytes:
        """Record a launch, and return the page that it opens. Raises LtiError."""
        now = datetime.now(UTC)
        if message.kind == DEEP_LINKING:
            return await self._picker(message, login, now, language)
        if message.kind in (REPORT, SETTINGS):
            return await self._reports.page(message, login, language)

        def entered(connection: Connection) -> Landing:
            use_login(connection, login, now)
            return enter(connection, message, self.secret, self.catalogue, now)

        landing = await write(self.store, entered)
        if landing.key_id:
            self.keys.expect_keys()
        if landing.role is not LtiRole.TUTOR:
            token = self._token(landing, now)
            return landing_page(landing, token, self.catalogue, self.assets, language)
        mine = LtiTicket(
            registration=message.registration.id,
            context=landing.context,
            link=landing.link,
            learner=self._reviewed(message),
        )
        ticket = signed_ticket(mine, self.secret, now)
        if landing.assignment is not None:
            is_review = bool(mine.learner)
            return tutor_page(
                landing, ticket, self.catalogue, self.assets, language, is_review=is_review
            )
        choice = Choice(landing.link_title)
        title = landing.course_title
        return choosing_page(choice, title, ticket, self.catalogue, self.assets, language)

    def _reviewed(self, message: LaunchMessage) -> str:
        """Return the id of the learner whose attempts a tutor wants to see, or ""."""
        if not message.reviewed:
            return ""
        return pseudonym(message.registration.id, message.reviewed, self.secret)

    async def _picker(
        self, message: LaunchMessage, login: Login, now: datetime, language: Language
    ) -> bytes:
        """Return the page on which a tutor chooses links for the platform. Raises LtiError."""

        def begun(connection: Connection) -> Offer:
            use_login(connection, login, now)
            ticket = begin_linking(connection, message, self.secret, now)
            return offer_of(connection, ticket, message.registration)

        offer = await write(self.store, begun)
        text = signed_ticket(offer.ticket, self.secret, now)
        return picker_page(offer, Picked(), text, self.catalogue, self.assets, language)

    def _token(self, landing: Landing, now: datetime) -> str:
        # Return the token for the page of a learner or of a tutor who previews it.
        # With the token of a preview, the page can grade, but not record. Guests get no token ("").
        if landing.role is LtiRole.GUEST or not landing.key_id or landing.assignment is None:
            return ""
        is_learner = landing.role is LtiRole.LEARNER
        scopes = {Scope.GRADE, Scope.RECORD} if is_learner else {Scope.GRADE}
        exercises = None
        if not is_learner:
            exercises = frozenset(each.exercise for each in landing.assignment.exercises)
        name = landing.learner or "lti-preview"
        caller = Caller(frozenset(scopes), exercises, name, landing.key_id)
        return self.keys.token(caller, now + TOKEN_LIFETIME)
