"""Write docs/problems.md, the page of all types of problems (errors over HTTP).

Run ``python -m tests.docs.problems > docs/problems.md``.
"""

import sys
from typing import Final

from dh_grader.contract import PROBLEM_TYPES, TYPE_PREFIX

_INTRODUCTION: Final = f"""\
# Problems

Every unsuccessful answer over HTTP is a problem document, `application/problem+json` (RFC 9457).
Its `type` is `{TYPE_PREFIX}` and one of the names below. The names do not
change; new versions may add names. If your program does not know a name, use the `status`, and show
`title` and `detail`: they are sentences for people, in the language of the reader.

The first {{count}} types are general: problems of this status that have no name of their own.

| Type | Status | Meaning |
|---|---|---|
"""
_CLOSING: Final = """
`refused` may have any status from 400 to 499 that no other general type has.

This page is generated: `python -m tests.docs.problems`.

## See also

- [HTTP](http.md#errors): requests and answers
- [Keys](keys.md#errors): problems of keys and tokens
- [Recorded attempts](attempts.md#record-one): problems of attempts
"""


def page() -> str:
    """Return the whole page, in Markdown."""
    count = sum(each.is_general for each in PROBLEM_TYPES.values())
    rows = [
        f'| <a id="{name}"></a>`{name}` | {each.status} | {each.meaning} |\n'
        for name, each in PROBLEM_TYPES.items()
    ]
    return _INTRODUCTION.format(count=count) + "".join(rows) + _CLOSING


if __name__ == "__main__":
    sys.stdout.write(page())
