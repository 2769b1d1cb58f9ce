"""Write the results as lines of a table."""

from statistics import median

from tests.frame_choice.trials import Tally

COLUMNS = (
    # heading, counted part, whole
    ("accepted", "valid accepted", "valid"),
    ("caught", "slip caught", "slip"),
    ("skew exact", "skew exact", "skew"),
    ("par. one row", "parallel one row", "parallel"),
    ("par. exact", "parallel exact", "parallel"),
    ("skew unshared", "skew unshared exact", "skew unshared"),
    ("par. unshared", "parallel unshared exact", "parallel unshared"),
    ("or as good", "as good", "slip"),
    ("two found", "two found", "two slips"),
    ("or as good", "two as good", "two slips"),
    ("two unshared", "two unshared found", "two unshared"),
)
WIDTH = 15
HEAD = f"{'':31}" + "".join(f"{name:>{WIDTH}}" for name, _, _ in COLUMNS) + "   ms right, wrong"


def by_policy(tally: Tally) -> str:
    lines = []
    for name in sorted({name for name, _ in tally.policies}):
        of = {key: count for (policy, key), count in tally.policies.items() if policy == name}
        lines.append(
            f"  {name:18} accepted {of.get('valid accepted', 0)} of {of.get('valid', 0)},"
            f" caught {of.get('slip caught', 0)} of {of.get('slip', 0)}"
        )
    return "\n".join(lines)


def line(name: str, tally: Tally) -> str:
    cells = []
    for _, part, whole in COLUMNS:
        counted = f"{tally.counts[part]}/{tally.counts[whole]}"
        share = f"{100 * tally.share(part, whole):.1f}"
        cells.append(
            f"{counted + ' ' + share:>{WIDTH}}" if tally.counts[whole] else f"{'-':>{WIDTH}}"
        )
    right = median(tally.right_ms) if tally.right_ms else 0.0
    wrong = median(tally.wrong_ms) if tally.wrong_ms else 0.0
    return f"{name:31}{''.join(cells)}   {right:5.2f} {wrong:6.2f}"
