"""A sampling profiler for the stages of a request."""

import signal
from collections import Counter
from collections.abc import Callable
from types import FrameType

# The first of these that is found in the stack names the stage.
_STAGES = (
    ("service/dh_grader/expressions/repairs/", "repairs"),
    ("service/dh_grader/grading/diagnosis/", "diagnosis"),
    ("service/dh_grader/expressions/printing.py", "printing"),
    ("service/dh_grader/pasting/", "pasting"),
    ("service/dh_grader/expressions/reader.py", "reading characters"),
    ("service/dh_grader/grading/reading/", "reading answers"),
    ("service/dh_grader/grading/marks.py", "follow-through"),
    ("service/dh_grader/grading/judging", "judging"),
    ("service/dh_grader/grading/frames/", "judging"),
    ("service/dh_grader/grading/marks.py", "judging"),
    ("service/dh_grader/grading/judging_table.py", "judging"),
    ("service/dh_grader/grading/kinds/", "judging"),
    ("service/dh_grader/formats/", "rendering"),
    ("service/dh_grader/store/", "recording"),
    ("service/dh_grader/submissions/", "body"),
    ("service/dh_grader/api/", "body"),
)
_EVALUATION = "service/dh_grader/expressions/evaluate.py"
INTERVAL = 0.001


def _path(frame: FrameType) -> str:
    return frame.f_code.co_filename.replace("\\", "/")


def _stage(frame: FrameType | None) -> tuple[str, str]:
    paths: list[str] = []
    innermost = ""
    follows = False
    while frame is not None:
        path = _path(frame)
        paths.append(path)
        if not innermost and "/dh_grader/" in path:
            innermost = f"{path.partition('/dh_grader/')[2]}:{frame.f_code.co_name}"
        if "/grading/kinds/" in path:
            follows |= bool(getattr(frame.f_locals.get("grading"), "following", False))
        frame = frame.f_back
    evaluates = any(_EVALUATION in path for path in paths)
    for part, stage in _STAGES:
        if any(part in path for path in paths) and not (evaluates and "reader" in part):
            return f"{stage}, following through" if follows else stage, innermost
    return "other", innermost


class Stages:
    """Counts the profiler's samples by stage of the request."""

    def __init__(self) -> None:
        self.stages: Counter[str] = Counter()
        self.functions: Counter[str] = Counter()

    def watch(self, action: Callable[[], object], rounds: int = 3) -> None:
        def look(_: int, frame: FrameType | None) -> None:
            stage, function = _stage(frame)
            self.stages[stage] += 1
            self.functions[function] += 1

        before = signal.signal(signal.SIGPROF, look)
        signal.setitimer(signal.ITIMER_PROF, INTERVAL, INTERVAL)
        try:
            for _ in range(rounds):
                action()
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.signal(signal.SIGPROF, before)

    def line(self, most: int = 3) -> str:
        return "; ".join(
            ", ".join(f"{name} {count / (counts.total() or 1):.0%}" for name, count in largest)
            for counts in (self.stages, self.functions)
            if (largest := counts.most_common(most))
        )
