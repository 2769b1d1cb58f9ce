"""Reports as JSON lines: one line for each file, written as soon as the file is graded."""

from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.documents.json import entries
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.report_format import ReportFormat, Setting
from service.regex import regex


def _pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    for entry in entries(submissions):
        yield entry + b"\n"


# A shard begins with its number.
_MARK: Final = regex(rb'\{"submission": "|\{"shard": \d+, "shards": ')

JSONL: Final = ReportFormat(_pieces, _MARK, is_stream=True)
