"""The services of platforms for handed-in files: notices, files (assets), and reports on them."""

import base64
import hashlib
import json
from collections.abc import Mapping
from math import inf
from time import monotonic
from typing import Any, Final
from urllib.parse import urljoin

from service.lti.fetching import TIMEOUT, FetchError, TooLargeError, answer, content
from service.lti.handed_files.notices import HANDED_IN, FileAtPlatform, HandedFiles
from service.lti.registrations import NOTICES_PATH, Registration
from service.lti.scores.access_tokens import AccessTokens
from service.lti.scores.grade_services import GradeServices, NotThereError
from service.lti.scores.score_problems import RefusedError, ThisLaterError
from service.submissions.file_content import most_bytes
from service.translations import say

_SCOPE: Final = "https://purl.imsglobal.org/spec/lti/scope/"
NOTICES: Final = f"{_SCOPE}noticehandlers"
READ: Final = f"{_SCOPE}asset.readonly"
REPORT: Final = f"{_SCOPE}report"
_JSON: Final = {"Content-Type": "application/json"}
_MOST_REDIRECTS: Final = 3
# How long all files of a submission may take (seconds).
_FILES_TIME: Final = 20.0


class NoFileError(Exception):
    """A file cannot be fetched or graded; ``reason`` says why.

    ``code`` is an error code of the LTI standard.
    """

    def __init__(self, code: str, reason: str) -> None:
        self.code, self.reason = code, reason
        super().__init__(reason)


class PlatformFiles:
    """Uses platforms' services for handed-in files, with the access tokens of this process."""

    def __init__(self, tokens: AccessTokens) -> None:
        self._services = GradeServices(tokens)

    def ask_for_notices(self, registration: Registration, service: str) -> None:
        """Ask the platform to send us notices of handed-in files. Raises ScoreError."""
        asked = {"notice_type": HANDED_IN, "handler": registration.address + NOTICES_PATH}
        self._send(registration, service, "PUT", NOTICES, asked)

    def send_report(self, registration: Registration, url: str, report: Mapping[str, Any]) -> None:
        """Send a report. Raises ScoreError."""
        # If the platform already has a newer report, nothing is raised.
        try:
            self._send(registration, url, "POST", REPORT, report)
        except ThisLaterError as error:
            if error.name != "stamp":
                raise

    def content_of(
        self, registration: Registration, file: FileAtPlatform, latest: float = inf
    ) -> bytes:
        """Return a file's content. Raises NoFileError, or ScoreError if a later try may succeed.

        ``latest`` is the time of ``monotonic`` at which the transfer ends at the latest.
        """
        # A platform may redirect to another host. The access token is sent to the first host only.
        local, until = registration.is_development, min(latest, monotonic() + TIMEOUT)
        try:
            asked = self._services.asked(
                registration, file.url, "GET", READ, {"headers": {}, "until": until}, redirects=True
            )
            url = file.url
            with asked as response:
                if not response.is_redirect:
                    return _checked(content(response, most_bytes(file.filename)), file)
                url = urljoin(url, response.headers.get("location", ""))
            for _ in range(_MOST_REDIRECTS):
                with answer(url, local=local, until=until) as response:
                    if response.is_success:
                        return _checked(content(response, most_bytes(file.filename)), file)
                    if not response.is_redirect:
                        raise FetchError(say("the status is {status}", status=response.status_code))
                    url = urljoin(url, response.headers.get("location", ""))
            raise FetchError(say("the answers are too many redirects"))
        except TooLargeError as error:
            raise NoFileError("ASSET_TOO_LARGE", error.args[0]) from error
        except FetchError as error:
            raise NoFileError("DOWNLOAD_FAILED", error.args[0]) from error
        except NotThereError as error:
            raise NoFileError("DOWNLOAD_FAILED", say("it is not there any more")) from error
        except RefusedError as error:
            raise NoFileError("DOWNLOAD_FAILED", error.args[0]) from error

    def contents_of(
        self, registration: Registration, files: HandedFiles
    ) -> dict[str, bytes | NoFileError]:
        """Return each file's content or error, by file id. Raises ScoreError."""
        found: dict[str, bytes | NoFileError] = {}
        latest = monotonic() + _FILES_TIME
        for each in files.assets:
            try:
                found[each.asset_id] = self.content_of(registration, each, latest)
            except NoFileError as error:
                found[each.asset_id] = error
        return found

    def _send(
        self, registration: Registration, url: str, method: str, scope: str, body: Any
    ) -> None:
        sent = {"content": json.dumps(body).encode(), "headers": _JSON}
        with self._services.asked(registration, url, method, scope, sent):
            return


def _checked(data: bytes, file: FileAtPlatform) -> bytes:
    # Platforms write the checksum in hexadecimal digits or in base 64.
    digest = hashlib.sha256(data).digest()
    known = (digest.hex(), base64.b64encode(digest).decode())
    expected = file.sha256_checksum
    if expected and expected.lower() != known[0] and expected != known[1]:
        raise NoFileError("DOWNLOAD_FAILED", say("its checksum is another one"))
    return data
