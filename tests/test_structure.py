"""Test the structure of the project: imports, sizes, and places of tests."""

# The source is parsed with `ast`, so that imports inside functions and for types count as well.

import ast
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import get_args

import pytest
from dh_grader.catalogue.kinds import SPECS
from dh_grader.cli import COMMANDS, PLACES
from dh_grader.grading.kinds import KINDS
from dh_grader.pasting import FORMATS
from dh_grader.solutions import ANSWERS, LAZY

ROOT = Path(__file__).parents[1]
SERVICE = ROOT / "service" / "dh_grader"
TESTS = ROOT / "tests"

# Each package or file of service/ may import those listed before it.
PACKAGES = (
    "version", "time_slices", "regex", "translations", "expressions", "grids", "typeset",
    "kinematics", "catalogue", "learning", "grading", "solutions", "figures", "hints", "authoring",
    "importing", "variants", "submissions", "contract", "statistics", "formats",
    "local_grading", "bundles", "attempts", "access", "courses", "lti", "client", "settings",
    "api", "web", "server", "cli", "app", "__main__",
)  # fmt: skip

# The packages of grading, in layers: each may import earlier layers, and packages of its own layer
# if there is no cycle.
GRADING_FLOORS = (
    {
        "feedback",
        "formula_text",
        "lost_points",
        "misconception",
        "numerics",
        "report",
        "work_budget",
    },
    {"reading"},
    {"part"},
    {"judging"},  # right or wrong; why it is wrong is diagnosis
    {"diagnosis"},
    {"follow_through"},  # asks kinds for a chain and knows none by name
    {"kinds"},
    {"grade"},
)
GRADING_ROOMS = 14
LINES = 1000
# Folders of tests that do not belong to a package of service/.
SUITES = {
    "docs",
    "installed",
    "exercises",
    "frame_choice",
    "pose_slips",
    "benchmarks",
    "attack",
    "load",
    "worst",
    "browser",
    "deploy",
    "front",
}


def module_name(file: Path) -> str:
    """Return the dotted name of a file, such as ``dh_grader.grading.judging``."""
    return ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


@cache
def trees() -> Mapping[str, ast.Module]:
    """Return the syntax tree of each module of service/."""
    files = sorted(SERVICE.rglob("*.py"))
    return {module_name(file): ast.parse(file.read_text(encoding="utf-8")) for file in files}


def imported_names(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@cache
def imports() -> Mapping[str, frozenset[str]]:
    """Return the imports between the modules of service/."""
    modules = trees()
    found = {}
    for module, tree in modules.items():
        targets = set()
        for name in imported_names(tree):
            target = name if name in modules else name.rpartition(".")[0]
            if target in modules and target != module:
                targets.add(target)
        found[module] = frozenset(targets)
    return found


def room(module: str, house: str) -> str:
    return module.removeprefix(f"{house}.").partition(".")[0]


def against_the_order(place: Mapping[str, int], house: str) -> list[str]:
    return [
        f"{module} imports {target}"
        for module, targets in imports().items()
        for target in sorted(targets)
        if module.startswith(f"{house}.")
        and target.startswith(f"{house}.")
        and place[room(module, house)] < place[room(target, house)]
    ]


def rooms(house: str) -> set[str]:
    return {room(module, house) for module in trees() if module.startswith(f"{house}.")}


def test_every_package_has_a_place_in_the_order() -> None:
    assert rooms("service") - set(PACKAGES) == set()


def test_no_package_imports_a_later_one() -> None:
    place = {package: i for i, package in enumerate(PACKAGES)}
    assert against_the_order(place, "service") == []


def test_every_room_of_grading_has_a_floor() -> None:
    assert rooms("dh_grader.grading") - set().union(*GRADING_FLOORS) == set()


def test_no_room_of_grading_imports_a_later_one() -> None:
    place = {room: i for i, floor in enumerate(GRADING_FLOORS) for room in floor}
    assert against_the_order(place, "dh_grader.grading") == []


def test_no_modules_import_each_other_in_a_circle() -> None:
    try:
        TopologicalSorter(imports()).prepare()
    except CycleError as error:
        pytest.fail(" <- ".join(error.args[1]))


def test_grading_stays_easy_to_survey() -> None:
    assert len(rooms("dh_grader.grading")) <= GRADING_ROOMS


def test_no_file_is_longer_than_one_can_read_at_once() -> None:
    lengths = {
        module_name(file): len(file.read_text(encoding="utf-8").splitlines())
        for file in SERVICE.rglob("*.py")
    }
    assert {module: length for module, length in lengths.items() if length > LINES} == {}


# The folders whose files each have an entry in a table of their package.
TABLES: Mapping[str, Callable[[], Iterable[object]]] = {
    "catalogue/parts": SPECS.values,
    "grading/kinds": lambda: (each for kind in KINDS.values() for each in (kind.read, kind.judge)),
    "solutions/kinds": lambda: [*ANSWERS.values(), *LAZY.values()],
}


@pytest.mark.parametrize("folder", TABLES)
def test_each_module_of_a_kind_is_in_the_table_of_its_package(folder: str) -> None:
    modules = {module_name(file) for file in (SERVICE / folder).glob("*.py")}
    listed = [str(each.__module__) for each in TABLES[folder]()]
    assert set(listed) == modules - {"service." + folder.replace("/", ".")}


def test_the_tables_have_the_same_kinds() -> None:
    assert list(SPECS) == list(KINDS) == list(ANSWERS) == list(LAZY) == sorted(SPECS)
    for kind, spec in SPECS.items():
        assert get_args(spec.model_fields["kind"].annotation) == (kind,)


def test_importing_the_diagnosis_imports_each_of_its_modules() -> None:
    package = "dh_grader.grading.diagnosis"
    modules = {name for name in trees() if name.startswith(f"{package}.")}
    with_code = {name for name in modules if trees()[name].body[1:]}
    assert with_code <= imports()[package]


def modules_with(name: str, folder: str) -> set[str]:
    """Return the modules of a folder that assign a name at their top level."""
    found = set()
    for file in (SERVICE / folder).rglob("*.py"):
        for each in trees()[module_name(file)].body:
            match each:
                case ast.Assign(targets=[ast.Name(id=known)]) if known == name:
                    found.add(module_name(file))
                case ast.AnnAssign(target=ast.Name(id=known)) if known == name:
                    found.add(module_name(file))
    return found


def test_each_format_of_pasted_text_is_tried() -> None:
    assert len(FORMATS) == len(modules_with("FORMAT", "grids")) > 10
    assert modules_with("FORMAT", "grids") <= imports()["dh_grader.pasting"]


def test_each_command_can_be_called() -> None:
    # A file with commands of a group is imported by the file of the group.
    listed = {place.partition(":")[0] for place in PLACES.values()}
    others = {name for module in trees() for name in imports()[module] if ".cli." in module}
    assert listed <= modules_with("commands", "cli") <= listed | others
    assert list(PLACES) == list(COMMANDS)


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
    """True if a test file is in the folder that belongs to the tested code."""
    # The tests of `service/dh_grader/x/y/z.py` are in `tests/x/y/test_z.py`, those of the package
    # `service/dh_grader/x/y` in `tests/x/y/test_y.py`, and those of a test helper next to the helper. In a
    # folder such as `tests/x`, a test file with a docstring may also be about the whole package.
    *folders, file = test.relative_to(TESTS).parts
    if not folders or folders[0] in SUITES:
        return True
    name = file.removeprefix("test_").removesuffix(".py")
    tested = SERVICE.joinpath(*folders, name)
    if tested.is_dir() or tested.with_suffix(".py").is_file():
        return True
    if name == folders[-1] or test.with_name(f"{name}.py").is_file():
        return True
    about = ast.get_docstring(ast.parse(test.read_text(encoding="utf-8")))
    return len(folders) == 1 and tested.parent.is_dir() and about is not None


def test_every_test_has_a_home() -> None:
    tests = sorted(TESTS.rglob("test_*.py"))
    assert [str(test.relative_to(ROOT)) for test in tests if not has_home(test)] == []
