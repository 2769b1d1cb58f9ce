from dh_grader.server.connections import GuardedState, too_busy
from dh_grader.server.metrics import Metrics


def test_a_refusal_is_counted_and_a_page_may_read_it() -> None:
    metrics = Metrics()
    state = GuardedState(["https://course.example.edu"], metrics)
    answer = state.refusal(too_busy(1), "/v1/preview", "https://course.example.edu")
    state.note_refusal("none")
    state.note_refusal("none")
    assert answer.status_code == 503
    assert answer.headers["Access-Control-Allow-Origin"] == "https://course.example.edu"
    counted = {
        sample.labels["status"]: sample.value
        for family in metrics._refusals.collect()
        for sample in family.samples
        if sample.name.endswith("_total")
    }
    assert counted == {"503": 1, "none": 2}
