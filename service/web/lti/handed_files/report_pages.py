"""The page with the report on files that a student has handed in at the learning platform.

The files are not stored here. For each view, the service reads them from the platform and grades
them again.
"""

import asyncio
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection

from service.access.keys import Secret
from service.api.courses.asking import write
from service.api.http.lookup import Catalogue
from service.attempts.store import AttemptStore
from service.catalogue import FeedbackLevel
from service.formats.documents.html import page_of
from service.lti.handed_files.grading import graded_files
from service.lti.handed_files.notices import HandedFiles
from service.lti.handed_files.platform_files import NoFileError, PlatformFiles
from service.lti.handed_files.queue import files_of
from service.lti.linking import check_deployment, pseudonym
from service.lti.logins import Login, use_login
from service.lti.messages import LTI, SETTINGS, LaunchMessage
from service.lti.platform_threads import PlatformThreads
from service.lti.problems import LtiError
from service.lti.registrations import Registration
from service.lti.roles import LtiRole
from service.lti.scores.score_problems import ScoreError
from service.translations import Language, joined
from service.web.assets import Assets
from service.web.lti.lti_pages import lti_page


class ReportPages:
    """Makes the pages that platforms open for handed-in files: a report, or the settings."""

    def __init__(
        self,
        assets: Assets,
        store: AttemptStore,
        secret: Secret,
        catalogue: Catalogue,
        feedback: FeedbackLevel,
        platform: PlatformFiles,
        threads: PlatformThreads,
    ) -> None:
        """``feedback`` is the highest feedback level for students."""
        self._assets, self._store, self._secret = assets, store, secret
        self._catalogue, self._feedback = catalogue, feedback
        self._platform, self._threads = platform, threads

    async def page(self, message: LaunchMessage, login: Login, language: Language) -> bytes:
        """Return the page that the platform's message asks for. Raises LtiError."""
        now = datetime.now(UTC)

        def found(connection: Connection) -> HandedFiles | None:
            use_login(connection, login, now)
            check_deployment(connection, message, now)
            return None if message.kind == SETTINGS else self._files(connection, message)

        files = await write(self._store, found)
        if files is None:
            return lti_page("file_settings.html", self._assets, [], language=language)
        contents = await self._contents(message.registration, files)
        graded = await asyncio.to_thread(
            graded_files,
            files,
            contents,
            self._catalogue,
            ceiling=self._feedback,
            for_students=message.role is not LtiRole.TUTOR,
            language=language,
        )
        if graded.submission is None:
            reasons = [each.reason for each in graded.failures.values()]
            raise LtiError("file-unreadable", reason=joined("; ", reasons))
        return page_of(graded.submission, language)

    def _files(self, connection: Connection, message: LaunchMessage) -> HandedFiles:
        submission = _id_in(message.claims, "submission")
        known = files_of(
            connection, message.registration.id, submission, _id_in(message.claims, "asset")
        )
        if known is None:
            raise LtiError("unknown-report")
        files, learner = known
        is_own = message.sub is not None and learner == pseudonym(
            message.registration.id, message.sub, self._secret
        )
        if not (message.role is LtiRole.TUTOR or (message.role is LtiRole.LEARNER and is_own)):
            raise LtiError("foreign-report")
        return files

    async def _contents(
        self, known: Registration, files: HandedFiles
    ) -> dict[str, bytes | NoFileError]:
        try:
            return await self._threads.run(
                known.id, lambda: self._platform.contents_of(known, files)
            )
        except ScoreError as error:
            raise LtiError("file-unreadable", reason=error) from error


def _id_in(claims: Mapping[str, Any], name: str) -> str:
    claim = claims.get(f"{LTI}{name}")
    found = claim.get("id") if isinstance(claim, dict) else None
    if not isinstance(found, str) or not 0 < len(found) <= 255:
        raise LtiError("bad-claim", claim=f"{LTI}{name}")
    return found
