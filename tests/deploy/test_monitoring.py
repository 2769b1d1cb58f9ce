"""The alert rules and the dashboard use only existing metrics and routes."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from dh_grader.api.permissions import RIGHTS
from dh_grader.server.metrics import Metrics
from prometheus_client.metrics import MetricWrapperBase

FOLDER = Path(__file__).parents[2] / "deploy" / "monitoring"
RULES: list[dict[str, Any]] = [
    rule
    for group in yaml.safe_load((FOLDER / "alerts.yaml").read_text(encoding="utf-8"))["groups"]
    for rule in group["rules"]
]
DASHBOARD: dict[str, Any] = json.loads((FOLDER / "grafana.json").read_text(encoding="utf-8"))
QUERIES = [rule["expr"] for rule in RULES] + [
    target["expr"] for panel in DASHBOARD["panels"] for target in panel["targets"]
]
# Labels that Prometheus itself adds.
OF_PROMETHEUS = {"instance", "job", "le"}


def samples() -> dict[str, set[str]]:
    """Return the names and labels of all metrics of the service."""
    endings = {
        "counter": ("_total",),
        "gauge": ("",),
        "histogram": ("_bucket", "_count", "_sum"),
    }
    return {
        f"{family.name}{ending}": set(metric._labelnames)
        for metric in vars(Metrics()).values()
        if isinstance(metric, MetricWrapperBase)
        for family in metric.describe()
        for ending in endings[family.type]
    }


SAMPLES = samples()


def test_every_metric_is_one_of_the_service() -> None:
    assert len(SAMPLES) > 10
    used = {name for query in QUERIES for name in re.findall(r"\bdh_grader_\w+", query)}
    assert len(used) > 8
    assert used - SAMPLES.keys() == set()


@pytest.mark.parametrize("query", QUERIES)
def test_every_label_is_one_of_its_metric(query: str) -> None:
    known = {label for name in re.findall(r"\bdh_grader_\w+", query) for label in SAMPLES[name]}
    grouped = [each.split(",") for each in re.findall(r"by \(([\w, ]*)\)", query)]
    selected = re.findall(r"[{,]\s*(\w+)\s*[=!]~?", query)
    used = {label.strip() for labels in grouped for label in labels} | set(selected)
    assert used - known - OF_PROMETHEUS == set()
    assert "_bucket" not in query or re.search(r"by \(le\b", query)


@pytest.mark.parametrize("query", QUERIES)
def test_the_brackets_of_a_query_are_in_pairs(query: str) -> None:
    assert all(query.count(a) == query.count(b) for a, b in ("()", "[]", "{}"))


def test_every_route_is_one_of_the_service() -> None:
    named = {route for query in QUERIES for route in re.findall(r'route="([^"]+)"', query)}
    assert named
    assert named <= {route.partition(" ")[2] for route in RIGHTS}


def test_labels_in_texts_are_left_by_the_query() -> None:
    for rule in RULES:
        for label in re.findall(r"\$labels\.(\w+)", rule["annotations"]["summary"]):
            assert re.search(rf"by \({label}\)", rule["expr"]), rule["alert"]
    for panel in DASHBOARD["panels"]:
        for target in panel["targets"]:
            for label in re.findall(r"{{(\w+)}}", target["legendFormat"]):
                assert re.search(rf"by \([^)]*\b{label}\b", target["expr"]), panel["title"]
