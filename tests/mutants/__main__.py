"""Change the code in small ways, and see that a test notices each change (``make mutants``).

``python -m tests.mutants [PACKAGE …] [--sample PERCENT] [--seed SEED] [--resume FILE]`` prints how
many mutants of each package were killed, and every survivor. It works in a copy of the checkout.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

from tests.mutants.session import Result, Wanted

ROOT: Final = Path(__file__).parents[2]
EQUIVALENT: Final = Path(__file__).parent / "equivalent.toml"
# The share of the mutants of a package that must be killed, equivalent ones apart.
LEAST: Final = 0.9


@dataclass(frozen=True, slots=True)
class Package:
    """Files that are changed, and the tests that should notice.

    Tests in the folders ``homes`` are tried first.
    """

    files: Sequence[str]
    tests: Sequence[str]
    homes: Sequence[str]


PACKAGES: Final[Mapping[str, Package]] = {
    "access": Package(
        ["service/dh_grader/access/*.py"],
        ["tests/access", "tests/api/test_scopes.py"],
        ["tests/access"],
    ),
    "permissions": Package(
        ["service/dh_grader/api/permissions.py"],
        [
            "tests/api/test_permissions.py",
            "tests/api/test_authentication.py",
            "tests/api/test_scopes.py",
        ],
        ["tests/api/test_permissions.py", "tests/api/test_authentication.py"],
    ),
    "terms": Package(
        ["service/dh_grader/courses/assignments.py"],
        [
            "tests/courses/test_terms.py",
            "tests/courses/test_courses.py",
            "tests/courses/test_paid_hints.py",
        ],
        ["tests/courses/test_terms"],
    ),
    "gradebook": Package(
        ["service/dh_grader/courses/gradebook.py"],
        ["tests/courses/test_gradebook.py", "tests/courses/test_courses.py"],
        ["tests/courses/test_gradebook.py"],
    ),
    "results": Package(
        ["service/dh_grader/store/results.py"],
        ["tests/store/test_results.py", "tests/api/test_recording.py"],
        ["tests/store/test_results.py"],
    ),
    "fair_points": Package(
        ["service/dh_grader/grading/judging_table.py"],
        [
            "tests/grading/frames",
            "tests/grading/test_fair_points.py",
            "tests/grading/test_judging_table.py",
            "tests/grading/test_marks.py",
            "tests/grading/test_points.py",
            "tests/grading/test_unread_cells.py",
            "tests/frame_choice/rows",
        ],
        ["tests/grading/test_fair_points.py"],
    ),
    "marks": Package(
        ["service/dh_grader/grading/marks.py", "service/dh_grader/grading/report.py"],
        [
            "tests/grading/test_marks.py",
            "tests/grading/test_fair_points.py",
            "tests/grading/test_points.py",
        ],
        ["tests/grading/test_marks.py", "tests/grading/test_points.py"],
    ),
    "comparison": Package(
        ["service/dh_grader/grading/numbers.py"],
        ["tests/grading/test_numbers.py", "tests/grading/test_rounding.py"],
        ["tests/grading/test_numbers.py"],
    ),
}


@dataclass(frozen=True, slots=True)
class Equivalent:
    """A mutant that changes no answer, and the reason.

    Without ``after``, all mutants of the statement ``before``.
    """

    file: str
    function: str
    before: str
    reason: str
    after: str | None = None

    def fits(self, result: Result) -> bool:
        """True if this is the mutant."""
        place = self.file, self.function, self.before
        is_here = place == (result.file, result.function, result.before)
        return is_here and self.after in (None, result.after)


def equivalents() -> list[Equivalent]:
    """Return the listed mutants that no test can notice."""
    listed = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))
    return [Equivalent(**each) for each in listed.get("mutant", ())]


def tried(
    package: Package,
    *,
    sample: int = 100,
    seed: str = "1",
    seconds: float = 20.0,
    functions: Sequence[str] = (),
    known: Mapping[str, str] | None = None,
    kept: Path | None = None,
) -> list[Result]:
    """Return the results of the mutants of a package, tried in a copy of the checkout."""
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        scratch = Path(folder) / "checkout"
        _copy_checkout(scratch)
        files = sorted(
            str(file.relative_to(scratch))
            for pattern in package.files
            for file in scratch.glob(pattern)
            if file.name != "__init__.py"
        )
        out = Path(folder) / "results.jsonl"
        wanted = Wanted(
            files=files,
            tests=list(package.tests),
            homes=list(package.homes),
            sample=sample,
            seed=seed,
            seconds=seconds,
            out=str(kept or out),
            functions=list(functions),
            known=dict(known or {}),
        )
        # The package of the copy, not that of this checkout, which the environment has installed.
        environment = {**os.environ, "TMPDIR": folder, "PYTHONPATH": str(scratch / "service")}
        done = subprocess.run(
            [sys.executable, "-m", "tests.mutants.session"],
            input=json.dumps(asdict(wanted)),
            text=True,
            cwd=scratch,
            capture_output=True,
            env=environment,
        )
        if done.returncode:
            raise RuntimeError(f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
        return read_results(kept or out)


def read_results(file: Path) -> list[Result]:
    """Read the results that a session has written; later lines replace earlier ones."""
    if not file.exists():
        return []
    lines = file.read_text(encoding="utf-8").splitlines()
    found = (Result(**json.loads(line)) for line in lines)
    return list({each.key: each for each in found}.values())


def _copy_checkout(scratch: Path) -> None:
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, check=True, text=True,
    ).stdout  # fmt: skip
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (scratch / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, scratch / name)


def report(name: str, results: Iterable[Result], listed: Sequence[Equivalent]) -> bool:
    """Print the results of a package; return True if enough mutants were killed."""
    ends: Counter[str] = Counter()
    survivors = []
    for each in results:
        same = next((one for one in listed if one.fits(each)), None)
        alive = each.end in ("survived", "unreached")
        ends["equivalent" if same is not None and alive else each.end] += 1
        if alive and same is None:
            survivors.append(each)
        elif same is not None and same.after is not None and not alive:
            print(f"  no longer equivalent: {each.file}:{each.line}: {each.before} -> {each.after}")
    dead = ends["killed"] + ends["time-out"]
    counted = dead + len(survivors)
    share = dead / counted if counted else 1.0
    told = ", ".join(f"{number} {end}" for end, number in sorted(ends.items()))
    print(f"{name}: {share:.1%} of {counted} killed ({told})")
    for each in survivors:
        unreached = " (no test reaches it)" if each.end == "unreached" else ""
        print(f"  {each.file}:{each.line}: {each.before} -> {each.after}{unreached}")
    return share >= LEAST


def _stale(listed: Iterable[Equivalent], results: Sequence[Result]) -> list[Equivalent]:
    return [each for each in listed if not any(each.fits(one) for one in results)]


def main() -> int:
    """Try the mutants that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("packages", nargs="*", metavar="PACKAGE", help=", ".join(PACKAGES))
    parser.add_argument("--sample", type=int, default=100, help="how many per cent of the mutants")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--seconds", type=float, default=20.0, help="of tests for a mutant")
    parser.add_argument("--function", action="append", default=[], help="only in this function")
    parser.add_argument("--resume", type=Path, help="a folder with results to keep and continue")
    options = parser.parse_args()
    listed, enough = equivalents(), True
    for name in options.packages or PACKAGES:
        package = PACKAGES[name]
        kept = options.resume.resolve() / f"{name}.jsonl" if options.resume else None
        known = {
            each.key: f"{each.end} {each.by}".strip()
            for each in (read_results(kept) if kept else [])
            if each.end in ("killed", "time-out")
        }
        results = tried(
            package,
            sample=options.sample,
            seed=options.seed,
            seconds=options.seconds,
            functions=options.function,
            known=known,
            kept=kept,
        )
        enough = report(name, results, listed) and enough
        if options.sample == 100 and not options.function:
            own = {each.file for each in results}
            for each in _stale([one for one in listed if one.file in own], results):
                print(
                    f"  stale in equivalent.toml: {each.file}: {each.before} -> {each.after or '…'}"
                )
                enough = False
    return 0 if enough else 1


if __name__ == "__main__":
    sys.exit(main())
