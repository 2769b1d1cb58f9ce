"""Test the structure of the project: imports, sizes, and places of tests."""

# The source is parsed with `ast`, so that imports inside functions and for types count as well.

import ast
import shutil
import subprocess
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Final, get_args

import pytest
from dh_grader.catalogue.kinds import SPECS
from dh_grader.cli import COMMANDS, PLACES
from dh_grader.expressions.repairs import RULES
from dh_grader.grading.kinds import KINDS
from dh_grader.pasting import FORMATS
from dh_grader.solutions.answers import ANSWERS
from dh_grader.solutions.answers import LAZY as LAZY_ANSWERS

ROOT = Path(__file__).parents[1]
SERVICE = ROOT / "service" / "dh_grader"
TESTS = ROOT / "tests"
PACKAGE = "dh_grader"

# Each package or file may import those listed before it.
PACKAGES: Final = (
    "regex", "slices", "translations", "expressions", "pasting", "typeset", "kinematics",
    "catalogue", "learning", "grading", "solutions", "figures", "hints", "authoring", "importing",
    "variants", "submissions", "contract", "statistics", "formats", "bundles", "store", "access",
    "courses", "lti", "client", "settings", "notebook", "api", "web", "server", "cli", "app",
    "__main__",
)  # fmt: skip
# The same inside of grading. Why an answer is wrong is diagnosis; judging only finds that it is.
GRADING: Final = (
    "report", "numbers", "misconception", "reading", "frames", "judging", "marks",
    "frames.nearest", "frames.roles", "judging_table", "diagnosis", "kinds", "grade",
)  # fmt: skip

# Ceilings, which may only fall: a change that lowers a number lowers it here, too. Only a new
# feature may raise the number of lines, by what its commit states.
LINES: Final = 96_263
FILES: Final = 198  # the goal is 175
PARAMETERS_IN_GRADING: Final = 20  # functions of grading with more than five; the goal is none
EXAMPLES_IN_RECORDS: Final = 345  # test data beside the misconceptions; the goal is none

LONGEST, SHORTEST = 1000, 120
TOO_LONG: Final[Mapping[str, int]] = {}
# Files that are no face (`__init__.py`) and yet shorter, each with its reason.
SHORT: Final = {
    "__main__.py": "an entry point",
    "app.py": "an entry point",
    "bundles/templates/prairielearn/server.py": "is copied into bundles",
    "cli/licences.py": "an entry point: the licences of the packages in the image",
    "cli/remote.py": "opens the client, which most runs do without",
    "cli/options.py": "loads the catalogue, without which the help and the version do",
    "notebook.py": "the face of the package for programs",
    "regex.py": "is below every package",
    "server/alive.py": "an entry point: the health check of the image",
    "slices.py": "is below every package",
    "solutions/solution.py": "is read without SymPy, by the client and the HTTP interface",
    "store/migrations/env.py": "an entry point of Alembic",
    "web/check_process.py": "an entry point: a process of its own",
}
# Databases exist at each of these revisions, so their files stay as they are.
MIGRATIONS: Final = "store/migrations/versions"
# A folder is made for five files or more. These have fewer, with their number.
SMALL_FOLDERS: Final = {
    "access": 3, "bundles": 1, "bundles/templates/prairielearn": 1, "contract": 3, "courses": 4,
    "grading/frames": 3, "importing": 4, "kinematics": 4, "store/migrations": 1,
    "solutions": 4, "translations": 1, "variants": 4,
}  # fmt: skip

# What may be imported inside functions, because it takes long to load and most runs do without.
LAZY: Final = {
    "alembic": "migrations only",
    "dh_grader.bundles": "one command",
    "dh_grader.cli.remote_grading": "loads the client",
    "dh_grader.courses.assignments": "drivers of databases",
    "dh_grader.courses.gradebook": "drivers of databases",
    "dh_grader.courses.roll": "drivers of databases",
    "dh_grader.client": "loads httpx, for runs with --server only",
    "dh_grader.notebook": "the face of the package imports the grader at the first call",
    "dh_grader.solutions": "SymPy takes half a second; nothing that grades needs it",
    "dh_grader.lti": "drivers of databases, and httpx",
    "dh_grader.server.metrics": "loads prometheus_client",
    "dh_grader.store": "drivers of databases; a service without a database has none",
    "jinja2": "pages and reports in HTML",
    "latex2mathml": "statements of exercises",
    "markdown_it": "statements of exercises",
    "mdit_py_plugins": "statements of exercises",
    "multiprocessing": "runs of several processes",
    "openpyxl": "hand-ins in .xlsx",
    "prometheus_client": "metrics, where they are switched on",
    "resource": "does not exist on Windows",
    "rich": "progress bars and consoles",
    "striprtf": "hand-ins in .rtf",
    "sympy": "model solutions",
    "xlrd": "hand-ins in .xls",
    "dh_grader.web.lti_pages": "drivers of databases",
    "dh_grader.web.lti_routes": "drivers of databases",
    "xlsxwriter": "the gradebook as a workbook",
}
# The other imports inside functions, by file. The numbers may only fall.
LATE: Final = {
    "api/courses.py": 10,
    "api/recording.py": 1,
    "cli/__init__.py": 7,
    "cli/attempts.py": 1,
    "cli/operate.py": 1,
    "server/__init__.py": 2,
    "web/check_process.py": 1,
    "web/courses.py": 4,
    "web/tutor.py": 5,
    "web/tutor_checks.py": 4,
}

# Folders of tests that do not belong to a package.
SUITES: Final = {
    "attack", "benchmarks", "browser", "deploy", "docs", "exercises", "frame_choice", "front",
    "installed", "load", "mutants", "pose_slips", "same", "worst",
}  # fmt: skip


def module_name(file: Path) -> str:
    """Return the dotted name of a file, such as ``dh_grader.grading.grade``."""
    return ".".join(file.relative_to(SERVICE.parent).with_suffix("").parts).removesuffix(
        ".__init__"
    )


@cache
def files() -> Mapping[str, Path]:
    """Return the Python files of the package by the names of their modules."""
    return {module_name(file): file for file in sorted(SERVICE.rglob("*.py"))}


def shown(file: Path) -> str:
    return file.relative_to(SERVICE).as_posix()


@cache
def lengths() -> Mapping[str, int]:
    """Return the number of lines of each file, by its path."""
    return {
        shown(file): len(file.read_text(encoding="utf-8").splitlines()) for file in files().values()
    }


@cache
def trees() -> Mapping[str, ast.Module]:
    """Return the syntax tree of each module."""
    return {name: ast.parse(file.read_text(encoding="utf-8")) for name, file in files().items()}


def imported_names(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def module_of(name: str) -> str:
    """Return the module of an imported name, if it is one of ours."""
    return name if name in trees() else name.rpartition(".")[0]


@cache
def imports() -> Mapping[str, frozenset[str]]:
    """Return the imports between the modules of the package."""
    # The face of the package imports at the first call what it stands for.
    return {
        module: frozenset(map(module_of, imported_names(tree))) & trees().keys() - {module}
        for module, tree in trees().items()
        if module != PACKAGE
    } | {PACKAGE: frozenset()}


HOUSES: Final = {PACKAGE: PACKAGES, f"{PACKAGE}.grading": GRADING}


def room(module: str, house: str) -> str:
    """Return the package or file of a module, or the module itself if the order lists it."""
    within = module.removeprefix(f"{house}.")
    return within if within in HOUSES[house] else within.partition(".")[0]


def rooms(house: str) -> set[str]:
    return {room(module, house) for module in trees() if module.startswith(f"{house}.")}


@pytest.mark.parametrize("house", HOUSES)
def test_every_room_has_a_place_in_the_order(house: str) -> None:
    assert sorted(HOUSES[house]) == sorted(rooms(house))


@pytest.mark.parametrize("house", HOUSES)
def test_no_room_imports_a_later_one(house: str) -> None:
    place = {room: i for i, room in enumerate(HOUSES[house])}
    assert [
        f"{module} imports {target}"
        for module, targets in imports().items()
        for target in sorted(targets)
        if module.startswith(f"{house}.")
        and target.startswith(f"{house}.")
        and place[room(module, house)] < place[room(target, house)]
    ] == []


def test_no_modules_import_each_other_in_a_circle() -> None:
    try:
        TopologicalSorter(imports()).prepare()
    except CycleError as error:
        pytest.fail(" <- ".join(error.args[1]))


# --- Sizes


def test_no_file_is_longer_than_one_can_read_at_once() -> None:
    too_long = {file: length for file, length in lengths().items() if length > LONGEST}
    assert too_long.keys() == TOO_LONG.keys()
    assert {file: n for file, n in too_long.items() if n > TOO_LONG[file]} == {}


def test_no_file_is_too_short_to_be_looked_for() -> None:
    short = {
        file
        for file, length in lengths().items()
        if length < SHORTEST
        and not file.endswith("__init__.py")
        and not file.startswith(f"{MIGRATIONS}/")
    }
    assert short == SHORT.keys()


def test_a_folder_is_made_for_five_files() -> None:
    # An empty `__init__.py` is not counted.
    sizes = Counter(str(Path(file).parent) for file, length in lengths().items() if length)
    assert {folder: n for folder, n in sizes.items() if n < 5} == SMALL_FOLDERS


def test_the_program_only_shrinks() -> None:
    assert sum(lengths().values()) <= LINES
    assert sum(1 for length in lengths().values() if length) <= FILES


# --- Functions


def functions(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node


def parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    given = function.args
    all_given = [*given.posonlyargs, *given.args, *given.kwonlyargs]
    starred = [each for each in (given.vararg, given.kwarg) if each]
    return len([each for each in all_given if each.arg not in ("self", "cls")]) + len(starred)


def test_a_function_of_grading_has_at_most_five_parameters() -> None:
    many = [
        f"{module}.{function.name}: {parameters(function)}"
        for module, tree in trees().items()
        if module.startswith(f"{PACKAGE}.grading.")
        for function in functions(tree)
        if parameters(function) > 5
    ]
    assert len(many) <= PARAMETERS_IN_GRADING, "\n".join(many)


def late_imports(tree: ast.Module) -> Iterator[str]:
    """Yield the names that are imported inside functions."""
    late = {
        node
        for function in functions(tree)
        for node in ast.walk(function)
        if isinstance(node, ast.Import | ast.ImportFrom)
    }
    for node in late:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif node.module:
            yield node.module


def test_imports_inside_functions_are_of_slow_packages() -> None:
    found: Counter[str] = Counter()
    for module, tree in trees().items():
        for name in late_imports(tree):
            if not any(f"{name}.".startswith(f"{lazy}.") for lazy in LAZY):
                found[shown(files()[module])] += 1
    assert found.keys() == LATE.keys()
    assert {file: n for file, n in found.items() if n > LATE[file]} == {}


# --- What the package holds


def test_the_package_holds_no_tests() -> None:
    names = {name for tree in trees().values() for name in imported_names(tree)}
    roots = {name.partition(".")[0] for name in names}
    assert roots & {"tests", "pytest", "hypothesis", "unittest"} == set()
    assert [file for file in lengths() if Path(file).name.startswith(("test_", "conftest"))] == []


def test_test_data_in_the_package_only_shrinks() -> None:
    records = [
        keyword
        for module, tree in trees().items()
        if module.startswith(f"{PACKAGE}.grading.")
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        for keyword in node.keywords
        if keyword.arg in ("example", "unlike")
    ]
    assert len(records) <= EXAMPLES_IN_RECORDS


@pytest.mark.skipif(
    shutil.which("git") is None or not (ROOT / ".git").exists(), reason="needs a clone"
)
def test_the_package_holds_no_generated_binaries() -> None:
    # The checkout may belong to another user.
    listed = subprocess.run(
        ["git", "-c", f"safe.directory={ROOT}", "ls-files", "-z", "service"],
        cwd=ROOT, capture_output=True, check=True,
    ).stdout.decode()  # fmt: skip
    held = [ROOT / name for name in listed.split("\0") if name and (ROOT / name).is_file()]
    assert len(held) > 300
    assert [file for file in held if b"\0" in file.read_bytes()] == []


# --- Tables in which everything of a kind is listed


def top_names(tree: ast.Module, *, imported: bool = False) -> Iterator[str]:
    """Yield the names that a module defines, or those that it imports."""
    for node in tree.body:
        match node:
            case ast.ImportFrom(names=names) if imported:
                yield from (alias.asname or alias.name for alias in names)
            case _ if imported:
                pass
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
                yield name


def test_the_tables_have_the_same_kinds() -> None:
    assert list(SPECS) == list(KINDS) == list(ANSWERS) == list(LAZY_ANSWERS) == sorted(SPECS)
    for kind, spec in SPECS.items():
        assert get_args(spec.model_fields["kind"].annotation) == (kind,)
        assert KINDS[kind].read.__name__ == f"read_{kind}_answer"
        assert KINDS[kind].judge.__name__ == f"judge_{kind}_answer"


def test_importing_the_diagnosis_imports_each_of_its_modules() -> None:
    package = f"{PACKAGE}.grading.diagnosis"
    modules = {name for name in trees() if name.startswith(f"{package}.")}
    assert len(modules) >= 8
    assert modules <= imports()[package]


def test_each_repair_is_tried() -> None:
    defined = {
        name
        for module, tree in trees().items()
        if module.startswith(f"{PACKAGE}.expressions.repairs.")
        for name in top_names(tree)
        if name.startswith("repair_")
    }
    assert len(RULES) == len(set(RULES)) == len(defined) > 50
    assert defined <= set(top_names(trees()[f"{PACKAGE}.expressions.repairs"], imported=True))


def test_each_format_of_pasted_text_is_tried() -> None:
    defined = [
        node
        for module, tree in trees().items()
        if module.startswith(f"{PACKAGE}.pasting.")
        for node in tree.body
        if isinstance(node, ast.AnnAssign | ast.Assign)
        and isinstance(node.value, ast.Call)
        and isinstance(node.value.func, ast.Name)
        and node.value.func.id == "GridFormat"
    ]
    assert len(FORMATS) == len(set(map(id, FORMATS))) == len(defined) > 10


def command_groups(tree: ast.Module) -> Iterator[str]:
    """Yield the public names of a module that are groups of commands."""
    for node in tree.body:
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Call(func=ast.Attribute(attr="Typer"))
            ) if not name.startswith("_"):
                yield name


def test_each_command_can_be_called() -> None:
    assert list(PLACES) == list(COMMANDS)
    assert len(set(PLACES.values())) == len(PLACES)
    defined = {
        f"{module}:{name}"
        for module, tree in trees().items()
        if module.startswith(f"{PACKAGE}.cli.")
        for name in command_groups(tree)
    }
    inner = {place for place in defined if place.endswith(":course_assignments_commands")}
    assert set(PLACES.values()) == defined - inner


# --- Names, and places of tests


def public_types(tree: ast.Module) -> Iterator[str]:
    """Yield the public classes and type aliases of a module."""
    for node in tree.body:
        match node:
            case ast.ClassDef(name=name):
                pass
            case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
                pass
            case _:
                continue
        if name[0].isupper() and not name.isupper():
            yield name


def test_no_two_public_types_share_a_name() -> None:
    homes: dict[str, list[str]] = defaultdict(list)
    for module, tree in trees().items():
        for name in public_types(tree):
            homes[name].append(module)
    assert {name: modules for name, modules in homes.items() if len(modules) > 1} == {}


def has_home(test: Path) -> bool:
    """True if a test file is in the folder of a package, or of a suite."""
    folder, *below = test.relative_to(TESTS).parts
    if not below:
        return True
    return folder in SUITES or folder in PACKAGES


def test_every_test_has_a_home() -> None:
    tests = sorted(TESTS.rglob("test_*.py"))
    assert [str(test.relative_to(ROOT)) for test in tests if not has_home(test)] == []
