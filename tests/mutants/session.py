"""A session of pytest that tries mutants: each in a process of its own, by the tests that reach it.

The session collects the tests once. It runs them once, with coverage, to find the lines that each
test reaches. Then it forks for each mutant: the child puts the changed code into the loaded modules
and runs the tests until one fails. Run by ``tests.mutants``, in a copy of the checkout.
"""

import ast
import gc
import importlib
import json
import os
import random
import resource
import signal
import subprocess
import sys
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import asdict, dataclass, field
from functools import _lru_cache_wrapper, partial
from itertools import count
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any, Final, TypeAlias

import pytest
from coverage import Coverage

from tests.mutants.mutations import mutants
from tests.shipped import shipped_exercises

# Seconds beyond the measured time of the tests after which a mutant counts as endless: of the
# processor, and of the clock, for mutants that wait for each other.
SPARE_CPU: Final = 20
SPARE_CLOCK: Final = 120
# Tests with these fixtures run the code in other processes, which a mutant does not reach.
_ELSEWHERE: Final = frozenset({"server", "visit", "browser", "killable"})

Cache: TypeAlias = "_lru_cache_wrapper[Any]"


def _databases() -> Any:
    # A plugin of the suite, which pytest must be the first to import.
    return importlib.import_module("tests.store.databases")


@dataclass(slots=True)
class Wanted:
    """What a session is to do, as ``tests.mutants`` writes it."""

    files: list[str]
    tests: list[str]
    homes: list[str]
    sample: int
    seed: str
    # The most seconds of tests for one mutant.
    seconds: float
    out: str
    # Only the mutants in these functions; empty for all.
    functions: list[str] = field(default_factory=list)
    # Results of an earlier run, by the key of a mutant.
    known: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Result:
    """The end of a mutant: killed (by a test), survived, time-out, or not reached by any test."""

    file: str
    line: int
    function: str
    before: str
    after: str
    end: str
    by: str = ""
    # Mutants of equal text in the same function have different numbers.
    number: int = 0

    @property
    def key(self) -> str:
        """The identity of the mutant, which does not depend on the place in the file."""
        return json.dumps([self.file, self.function, self.before, self.after, self.number])


class Mutating:
    """The plugin of pytest that tries the mutants in the place of running the tests."""

    def __init__(self, wanted: Wanted) -> None:
        self._wanted = wanted
        self._out = Path(wanted.out).open("a", encoding="utf-8")  # noqa: SIM115 (until the end)

    def pytest_sessionstart(self) -> None:
        """Load the files that are changed, also those that no test imports."""
        # Not before pytest has found its plugins: some of them are loaded by these files.
        for file in self._wanted.files:
            importlib.import_module(file.removesuffix(".py").replace("/", "."))

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        items[:] = [
            each for each in items if _ELSEWHERE.isdisjoint(getattr(each, "fixturenames", ()))
        ]

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        if session.testsfailed:
            raise session.Interrupted("the tests cannot be collected")
        shipped_exercises()
        needs_server = any("postgresql" in each.nodeid for each in session.items)
        databases = _databases()
        with databases.postgresql_server() if needs_server else nullcontext() as server:
            databases.postgresql_server = lambda: nullcontext(server)
            reached = self._reached(session)
            for file in self._wanted.files:
                self._try_file(session, file, reached)
        self._out.close()
        return True

    def _reached(self, session: pytest.Session) -> "Reached":
        """Return the lines that each test reaches, measured in another process."""
        here = Path(self._wanted.out).with_suffix(".reached.json")
        files = {each: Path(each).read_text(encoding="utf-8") for each in self._wanted.files}
        known = json.loads(here.read_text(encoding="utf-8")) if here.exists() else {}
        if known.get("files") != files:
            known = {"files": files, "seconds": {}, "lines": {file: {} for file in files}}
        if new := [each for each in session.items if each.nodeid not in known["seconds"]]:
            ended = _forked(lambda: _measure(session, new, known, here), 7200, 7200)
            if ended != "done":
                raise session.Interrupted(f"the tests could not be measured: {ended}")
        return Reached(json.loads(here.read_text(encoding="utf-8")))

    def _try_file(self, session: pytest.Session, file: str, reached: "Reached") -> None:
        source = Path(file).read_text(encoding="utf-8")
        tree = ast.parse(source)
        listed = list(mutants(tree))
        only = self._wanted.functions
        wanted = [i for i, each in enumerate(listed) if not only or each.function in only]
        drawn = random.Random(f"{self._wanted.seed} {file}")
        chosen = set(drawn.sample(wanted, -(-len(wanted) * self._wanted.sample // 100)))
        numbers: Counter[tuple[str, str, str]] = Counter()
        by_node = {each.nodeid: each for each in session.items}
        called = _called_by_module(tree)
        loaded = sys.modules[file.removesuffix(".py").replace("/", ".")]
        functions = functions_of(loaded)
        caches = _caches_of([file])
        gc.freeze()  # so that no child copies the pages of the collected tests
        for i, mutant in enumerate(mutants(tree)):
            place = (mutant.function, mutant.before, mutant.after)
            number = numbers[place]
            numbers[place] += 1
            if i not in chosen:
                continue
            told = Result(file, mutant.line, *place, "", number=number)
            if (known := self._wanted.known.get(told.key)) is not None:
                end = known
            else:
                ran = mutant.place == "function" and mutant.function.split(".")[0] not in called
                names = reached.tests(
                    file, mutant.line if ran else None, self._wanted.homes, self._wanted.seconds
                )
                # A test that was measured before may have another name now.
                items = [by_node[n] for n in names if n in by_node]
                if not items:
                    end = "unreached"
                elif mutant.place == "definition":
                    end = _tried_afresh(file, tree, items, 3 * self._wanted.seconds + SPARE_CLOCK)
                else:
                    mutate = partial(put_into, loaded, functions, tree, assignments=not ran)
                    end = self._tried(session, items, mutate, caches)
            kind, _, by = end.partition(" ")
            self._out.write(json.dumps(asdict(told) | {"end": kind, "by": by}) + "\n")
            self._out.flush()

    def _tried(
        self,
        session: pytest.Session,
        items: Sequence[pytest.Item],
        mutate: Callable[[], None],
        caches: Sequence[Cache],
    ) -> str:
        def ended() -> str:
            mutate()
            _clear(caches)
            return _first_failure(session, items)

        seconds = self._wanted.seconds
        return _forked(ended, 3 * seconds + SPARE_CPU, 5 * seconds + SPARE_CLOCK)


class Reached:
    """The lines that each test reaches, and its seconds."""

    def __init__(self, measured: Mapping[str, Any]) -> None:
        # A test that failed without any mutant tells nothing.
        told = measured["seconds"].items()
        self._seconds = {name: seconds for name, seconds in told if seconds is not None}
        self._lines: Mapping[str, Mapping[str, Sequence[str]]] = measured["lines"]

    def tests(self, file: str, line: int | None, homes: Sequence[str], most: float) -> list[str]:
        """Return the tests that reach a line (or any line, if None) within ``most`` seconds.

        Tests in the folders ``homes`` come first, and of those the fastest.
        """
        lines = self._lines.get(file, {})
        if line is None:
            # Constants alone run only when they are loaded, before any test.
            found = {each for names in lines.values() for each in names} or set(self._seconds)
        else:
            found = set(lines.get(str(line), ()))

        def order(name: str) -> tuple[bool, float, str]:
            return not name.startswith(tuple(homes)), self._seconds[name], name

        chosen: list[str] = []
        spent = 0.0
        for name in sorted(found & self._seconds.keys(), key=order):
            spent += self._seconds[name]
            if chosen and spent > most:
                break
            chosen.append(name)
        return chosen


def _measure(
    session: pytest.Session, items: Sequence[pytest.Item], known: dict[str, Any], out: Path
) -> str:
    # Add the lines that ``items`` reach to those that are known, and write all.
    files = known["files"]
    measured = Coverage(
        data_file=None, include=list(files), concurrency=["thread", "greenlet"], config_file=False
    )
    failed = _Failures(session)
    caches = _caches_of(files)
    measured.start()
    for item, following in _with_next(items):
        # What an earlier test has left in a cache hides the lines that compute it.
        _clear(caches)
        measured.switch_context(item.nodeid)
        before = time.process_time()
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        known["seconds"][item.nodeid] = None if failed.take() else time.process_time() - before
    measured.stop()
    data = measured.get_data()
    for file, source in files.items():
        found = data.contexts_by_lineno(str(Path(file).resolve()))
        lines = known["lines"][file]
        for line, names in _spread(source, found).items():
            lines[str(line)] = sorted({*lines.get(str(line), ()), *names})
    out.write_text(json.dumps(known), encoding="utf-8")
    return "done"


def _spread(source: str, found: Mapping[int, Sequence[str]]) -> dict[int, list[str]]:
    # Coverage counts a statement of several lines by its first line; a mutant may be in any.
    lines = {line: set(names) for line, names in found.items()}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.stmt) and hasattr(node, "lineno"):
            last = node.end_lineno or node.lineno
            body = getattr(node, "body", None) or getattr(node, "cases", None)
            if body:
                last = max(node.lineno, getattr(body[0], "lineno", node.lineno + 1) - 1)
            inside: set[str] = set()
            for line in range(node.lineno, last + 1):
                inside |= set(found.get(line, ()))
            for line in range(node.lineno, last + 1):
                lines.setdefault(line, set()).update(inside)
    return {line: sorted(names - {""}) for line, names in lines.items()}


class _Failures:
    # Remembers whether a test has failed since the last time it was asked.
    def __init__(self, session: pytest.Session) -> None:
        self._has_failed = False
        session.config.pluginmanager.register(self)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self._has_failed |= report.failed

    def take(self) -> bool:
        failed, self._has_failed = self._has_failed, False
        return failed


def _with_next(items: Sequence[pytest.Item]) -> Iterator[tuple[pytest.Item, pytest.Item | None]]:
    return zip(items, [*items[1:], None], strict=True)


def _first_failure(session: pytest.Session, items: Sequence[pytest.Item]) -> str:
    failed = _Failures(session)
    for item, following in _with_next(items):
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if failed.take():
            with suppress(Exception):
                session._setupstate.teardown_exact(None)
            return f"killed {item.nodeid}"
    return "survived"


def _forked(work: Callable[[], str], cpu: float, clock: float) -> str:
    """Return the result of ``work`` in a forked process, which may change anything in it."""
    reading, writing = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a fork beside threads
        child = os.fork()
    if not child:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CPU, (int(cpu) + 1, int(cpu) + 1))
        _databases().TEMPLATE = f"with_tables{os.getpid()}"
        _databases()._number = count(os.getpid() * 1000)
        try:
            told = work()
        except BaseException:  # noqa: BLE001 (also the exits that a mutant causes)
            told = f"killed at once: {traceback.format_exc()[-500:]}"
        os.write(writing, told.encode()[:4000])
        os._exit(0)
    os.close(writing)
    until = time.monotonic() + clock
    while (ended := os.waitpid(child, os.WNOHANG))[0] == 0 and time.monotonic() < until:
        time.sleep(0.01)
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    if ended[0] == 0:
        os.waitpid(child, 0)
    with os.fdopen(reading, encoding="utf-8") as pipe:
        told = pipe.read()
    if told:
        return told
    is_endless = ended[0] == 0 or os.WIFSIGNALED(ended[1])
    return "time-out" if is_endless else "killed by its end"


def _tried_afresh(file: str, tree: ast.Module, items: list[pytest.Item], clock: float) -> str:
    """Return the end of a mutant that is tried by a new Python, with the changed file."""
    # Classes cannot be changed after others have used them.
    path, before = Path(file), Path(file).read_bytes()
    path.write_text(ast.unparse(tree), encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-x", "-q", *OPTIONS]
    try:
        ended = subprocess.run(
            [*command, *(each.nodeid for each in items)], capture_output=True, timeout=clock
        )
    except subprocess.TimeoutExpired:
        return "time-out"
    finally:
        path.write_bytes(before)
    return "survived" if ended.returncode == 0 else "killed"


OPTIONS: Final = ("-p", "no:cacheprovider", "-p", "no:xdist", "-o", "timeout=0")


def functions_of(loaded: ModuleType) -> list[FunctionType]:
    """Return all functions of a loaded module, with methods and closures."""
    gc.unfreeze()  # the suite freezes what was loaded before the tests were collected
    return [
        each
        for each in gc.get_objects()
        if isinstance(each, FunctionType) and each.__code__.co_filename == loaded.__file__
    ]


def _caches_of(files: Iterable[str]) -> list[Cache]:
    # The memoized functions of files.
    paths = {str(Path(each).resolve()) for each in files}
    gc.unfreeze()
    found = [each for each in gc.get_objects() if isinstance(each, _lru_cache_wrapper)]
    return [each for each in found if _place_of(each) in paths]


def _place_of(cache: Cache) -> str | None:
    code = getattr(cache.__wrapped__, "__code__", None)
    return code and str(Path(code.co_filename).resolve())


def _clear(caches: Iterable[Cache]) -> None:
    for each in caches:
        each.cache_clear()


def put_into(
    loaded: ModuleType, functions: Sequence[FunctionType], tree: ast.Module, *, assignments: bool
) -> None:
    """Put changed code into a loaded module, also where its values were imported to."""
    codes = _by_place(compile(tree, str(loaded.__file__), "exec"))
    for each in functions:
        code = each.__code__
        new = codes.get((code.co_qualname, code.co_firstlineno), [])
        if len(new) == 1 and new[0] != code and len(new[0].co_freevars) == len(code.co_freevars):
            each.__code__ = new[0]
    if assignments:
        gc.unfreeze()
        _assign(loaded, tree)


def _by_place(code: CodeType) -> dict[tuple[str, int], list[CodeType]]:
    found: dict[tuple[str, int], list[CodeType]] = defaultdict(list)
    waiting = [code]
    while waiting:
        each = waiting.pop()
        found[each.co_qualname, each.co_firstlineno].append(each)
        waiting += [inner for inner in each.co_consts if isinstance(inner, CodeType)]
    return found


def _assign(loaded: ModuleType, tree: ast.Module) -> None:
    # Make the constants of the module again, and put them where the old ones are.
    names = dict(vars(loaded))
    for statement in tree.body:
        if not isinstance(statement, ast.Assign | ast.AnnAssign) or statement.value is None:
            continue
        exec(compile(ast.Module([statement], []), str(loaded.__file__), "exec"), names)  # noqa: S102
        targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
        for target in targets:
            if isinstance(target, ast.Name):
                old = vars(loaded)[target.id]
                new = names[target.id]
                if _is_equal(old, new):
                    names[target.id] = old
                else:
                    _replace(target.id, old, new)


def _is_equal(old: object, new: object) -> bool:
    try:
        return type(old) is type(new) and (repr(old) == repr(new) or bool(old == new))
    except Exception:  # noqa: BLE001 (SQL conditions have no truth)
        return False


def _replace(name: str, old: object, new: object) -> None:
    if isinstance(old, dict) and isinstance(new, dict):
        old.clear()
        old.update(new)
        return
    for module in list(sys.modules.values()):
        if getattr(module, "__dict__", {}).get(name) is old:
            setattr(module, name, new)
    if isinstance(old, bool | int | str | None):
        return
    for each in gc.get_objects():
        if isinstance(each, FunctionType):
            if each.__defaults__ and any(value is old for value in each.__defaults__):
                each.__defaults__ = tuple(new if v is old else v for v in each.__defaults__)
            named = each.__kwdefaults__ or {}
            named.update({key: new for key, value in named.items() if value is old})


def _called_by_module(tree: ast.Module) -> set[str]:
    # The functions that run when the module is loaded.
    found = {"<lambda>"}
    for statement in tree.body:
        if isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value is not None:
            for node in ast.walk(statement.value):
                if isinstance(node, ast.Name):
                    found.add(node.id)
    return found


def main() -> int:
    """Read what is wanted from standard input, and try the mutants."""
    wanted = Wanted(**json.load(sys.stdin))
    return int(
        pytest.main(
            [*OPTIONS, "-q", "--no-header", "--capture=fd", *wanted.tests],
            plugins=[Mutating(wanted)],
        )
    )


if __name__ == "__main__":
    sys.exit(main())
