"""Lint the OpenAPI document, generate clients from it, and use them: ``make clients``.

The command needs node's npx, and the registries of npm and PyPI. It installs into a temporary
folder.
"""

import json
import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path
from typing import Final

from dh_grader.app import app

from tests.api.serving import served

_TYPESCRIPT: Final = """\
import type { components, operations } from "./schema";

type Schemas = components["schemas"];
const body: Schemas["GradeRequest"] = { answers: { table: "a1, 0, 0, q1" } };
const many: Schemas["GradeManyRequest"] = { submissions: [{ exercise: "planar-rr", ...body }] };
type Answer = operations["gradeMany"]["responses"][200]["content"]["application/json"];

export function told(answer: Answer): string[] {
  return answer.results.flatMap((result) =>
    result.report
      ? result.report.parts.flatMap((part) => part.feedback.map((each) => each.message))
      : [result.problem?.detail ?? ""],
  );
}

export function size(shape: Schemas["Part"]["shape"]): number {
  switch (shape.form) {
    case "matrix":
      return shape.rows.length * shape.columns.length;
    case "list":
      return shape.components.length;
    default:
      return many.submissions.length;
  }
}
"""
_PYTHON: Final = """\
import sys
from dh_grader_client import Client
from dh_grader_client.api.exercises import get_exercise
from dh_grader_client.api.grading import grade, grade_many
from dh_grader_client.models import (
    DhTableShape, ExerciseSubmission, ExerciseSubmissionAnswers, GradeManyRequest, GradeRequest,
    GradeRequestAnswers, Problem, Report, Verdict,
)

client = Client(base_url=sys.argv[1], raise_on_unexpected_status=True)
table = {"table": {"rows": [["a1", 0, 0, "q1"], ["a2", 0, 0, "q2"]]}}
body = GradeRequest(answers=GradeRequestAnswers.from_dict(table))
report = grade.sync("planar-rr", client=client, body=body)
assert isinstance(report, Report), report
assert report.parts[0].verdict is Verdict.CORRECT, report
assert isinstance(grade.sync("planar", client=client, body=body), Problem)
answers = ExerciseSubmissionAnswers.from_dict(table)
both = [ExerciseSubmission(answers, exercise) for exercise in ("planar-rr", "planar")]
results = grade_many.sync(client=client, body=GradeManyRequest(both)).results
assert results[0].report == report and results[1].problem.status == 404, results
exercise = get_exercise.sync("planar-rr", client=client)
assert isinstance(exercise.parts[0].shape, DhTableShape), exercise
"""


def run(folder: Path, *command: str) -> str:
    """Run a command and return its output; exit if it fails."""
    sys.stdout.write(f"$ {' '.join(command)}\n")
    sys.stdout.flush()
    result = subprocess.run(
        command, cwd=folder, check=False, text=True, stdout=subprocess.PIPE,
        env=os.environ | {"NO_COLOR": "1"},
    )  # fmt: skip
    if result.returncode:
        raise SystemExit(result.stdout)
    return result.stdout


def npx(folder: Path, package: str, *command: str) -> str:
    """Run a program of an npm package; return its output."""
    return run(folder, "npx", "--yes", f"--package={package}", *command)


def lint(folder: Path) -> None:
    """Check the document with redocly; exit if there is a warning."""
    found = json.loads(
        npx(folder, "@redocly/cli@2", "redocly", "lint", "--format=json", "openapi.json")
    )
    if any(found["totals"].values()):
        raise SystemExit(json.dumps(found["problems"], indent=2))


def typescript(folder: Path) -> None:
    """Generate TypeScript types, and type-check a program that uses them."""
    npx(folder, "openapi-typescript@7", "openapi-typescript", "openapi.json", "-o", "schema.d.ts")
    (folder / "client.ts").write_text(_TYPESCRIPT, encoding="utf-8")
    npx(folder, "typescript@5", "tsc", "--strict", "--target", "es2022", "--noEmit", "client.ts")


def python(folder: Path) -> None:
    """Generate a client for Python, and use it on a real server."""
    venv.create(folder / "venv", with_pip=True)
    own = str(folder / "venv" / "bin" / "python")
    run(folder, own, "-m", "pip", "install", "--quiet", "openapi-python-client")
    (folder / "config.yml").write_text("post_hooks: []\n", encoding="utf-8")
    run(
        folder, own, "-m", "openapi_python_client", "generate", "--path", "openapi.json",
        "--output-path", "dh_grader_client", "--meta", "none", "--config", "config.yml",
        "--fail-on-warning",
    )  # fmt: skip
    (folder / "use.py").write_text(_PYTHON, encoding="utf-8")
    with served(folder) as server:
        run(folder, own, "use.py", server.address)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "openapi.json").write_text(json.dumps(app.openapi()), encoding="utf-8")
        lint(folder)
        typescript(folder)
        python(folder)
    sys.stdout.write("The document is clean; clients for TypeScript and Python work.\n")


if __name__ == "__main__":
    main()
