"""Before its script arrives, a form never puts its fields into the address."""

import re
from pathlib import Path

import pytest
from dh_grader.web import pages

PAGES = sorted(Path(pages.__file__).parent.rglob("*.html"))
FORMS = [
    (page, form) for page in PAGES for form in re.findall(r"<form\b[^>]*>", page.read_text("utf-8"))
]


@pytest.mark.parametrize(("page", "form"), FORMS, ids=lambda each: getattr(each, "name", None))
def test_no_form_puts_its_fields_into_an_address(page: Path, form: str) -> None:
    # If a form has no method, a browser puts the typed text into the query of the address.
    [method] = re.findall(r'method="(\w+)"', form)
    assert method in ("post", "dialog"), page
