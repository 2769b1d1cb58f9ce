"""The ``result.json`` of a Classroom 50 autograder, schema ``classroom50/result/v1``.

Source: https://github.com/foundation50/classroom50, ``schemas/result-v1.schema.json``, and its
wiki, "Advanced Autograding". In Classroom 50, a score is a whole number, so the scores in this file
count hundredths of a point.
"""

from collections.abc import Mapping
from typing import Any, Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.json_document import json_document
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.report_format import (
    ReportFormat,
    Setting,
    UnusableSettingError,
    single,
)
from service.regex import regex

# Each field with the environment variables of the runner; the first that is set counts.
_FIELDS: Final[Mapping[str, tuple[str, ...]]] = {
    "classroom": ("CLASSROOM",),
    "assignment": ("ASSIGNMENT",),
    "owner": ("OWNER", "USERNAME", "GITHUB_ACTOR"),
    "submission": ("SUBMISSION_TAG",),
    "commit": ("COMMIT_URL",),
    "release": ("RELEASE_URL",),
}
_TYPES: Final = ("ASSIGNMENT_TYPE", "MODE")
_HUNDREDTHS: Final = 100


def _document(submission: GradedSubmission, setting: Setting) -> bytes:
    tests = [_test(each) for each in part_results(submission, setting.language)]
    content = {
        "schema": "classroom50/result/v1",
        **_identity(setting.environment),
        "datetime": setting.now.strftime("%Y-%m-%dT%H:%M:%SZ"),
        "score": sum(test["score"] for test in tests),
        "max-score": sum(test["max-score"] for test in tests),
        "tests": tests,
    }
    return json_document(content)


def _identity(environment: Mapping[str, str]) -> dict[str, str]:
    found = {field: _first(environment, names) for field, names in _FIELDS.items()}
    lacking = [_FIELDS[field][0] for field, value in found.items() if not value]
    if lacking:
        raise UnusableSettingError(
            "the runner of Classroom 50 sets environment variables that are not here: "
            f"{', '.join(lacking)}"
        )
    return {
        "assignment_type": _first(environment, _TYPES) or "individual",
        **found,
        "review": environment.get("REVIEW_URL") or found["commit"],
    }


def _first(environment: Mapping[str, str], names: tuple[str, ...]) -> str:
    return next((environment[name] for name in names if environment.get(name)), "")


def _test(result: PartResult) -> dict[str, Any]:
    return {
        "test-name": result.name,
        "passed": result.passed,
        # Not rounded up to points that were not earned.
        "score": int(result.points * _HUNDREDTHS + 1e-3),
        "max-score": round(result.max_points * _HUNDREDTHS),
        "output": "\n".join(result.lines()),
    }


_MARK: Final = regex(rb'\{\s*"schema": "classroom50/result/v1",')

CLASSROOM50: Final = ReportFormat(single(_document), _MARK, is_single=True, for_students=True)
