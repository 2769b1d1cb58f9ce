"""A long fuzz of the reader: `python -m tests.fuzz --count 100000`.

Prints what it found, and exits with 1 where a limit was broken: an exception that is no
ExpressionError, a text that costs 50 ms, a second reading that differs, memory that grows.
"""

import argparse
import gc
import sys
import time
import tracemalloc
from collections import Counter
from collections.abc import Sequence

from tests.expressions.fuzzing import outcome, texts

COSTLY = 0.050
# The caches are emptied before each reading, so that nothing may be left behind.
LEAK = 8 * 2**20


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the fuzz; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    escaped: list[str] = []
    differing: list[str] = []
    codes: Counter[str] = Counter()
    slowest, slowest_text = 0.0, ""
    early = 0
    tracing_from = max(1, options.count - options.count // 10)
    begin = time.process_time()
    for number, text in enumerate(texts(options.count, options.seed), 1):
        if number == tracing_from:
            gc.collect()
            tracemalloc.start()
            early = tracemalloc.get_traced_memory()[0]
        degrees = number % 2 == 0
        try:
            first = outcome(text, degrees=degrees)
            second = outcome(text, degrees=degrees)
        except Exception as error:  # noqa: BLE001 - whatever escapes is what is looked for
            escaped.append(f"{text!r}: {error!r}")
            continue
        if first.fingerprint != second.fingerprint:
            differing.append(repr(text))
        # A garbage collection or another program may slow one of the two.
        seconds = min(first.seconds, second.seconds)
        if seconds > slowest:
            slowest, slowest_text = seconds, text
        is_error = len(first.fingerprint) == 4
        codes[str(first.fingerprint[0]) if is_error else "read"] += 1
    gc.collect()
    growth = tracemalloc.get_traced_memory()[0] - early if tracemalloc.is_tracing() else 0
    tracemalloc.stop()
    spent = time.process_time() - begin
    report = [
        f"{options.count} texts, seed {options.seed}, {spent:.0f} s of processor time",
        f"read: {codes['read']}; refused: {codes.total() - codes['read']} in {len(codes) - 1} ways",
        f"escaped: {len(escaped)}",
        *escaped[:20],
        f"differing between two readings: {len(differing)}",
        *differing[:20],
        f"slowest: {1000 * slowest:.1f} ms for {slowest_text[:120]!r}",
        f"growth of memory over the last tenth: {growth / 1024:.0f} KiB",
    ]
    sys.stdout.write("\n".join(report).encode("utf-8", "backslashreplace").decode() + "\n")
    return 1 if escaped or differing or slowest >= COSTLY or growth > LEAK else 0


if __name__ == "__main__":
    raise SystemExit(main())
