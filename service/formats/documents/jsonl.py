"""Reports as JSON lines: one line for each file, written as soon as the file is graded."""

import re
from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.documents.json import entries
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.report_format import ReportFormat, Setting


def _pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    for entry in entries(submissions):
        yield entry + b"\n"


# A shard begins with its number.
_MARK: Final = re.compile(rb'\{"submission": "|\{"shard": \d+, "shards": ')

FORMAT: Final = ReportFormat(_pieces, _MARK, is_stream=True)
