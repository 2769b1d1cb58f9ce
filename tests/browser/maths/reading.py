"""Find names such as theta1 that a page shows as plain text instead of as formulas."""

import re
from typing import Final

from playwright.sync_api import Page

# Names as they are typed. Names in Unicode, such as θ₁ and {0}, are typeset.
_TYPED: Final = re.compile(
    r"(?<![A-Za-z])(?:alpha|beta|gamma|theta|phi|psi|omega|pi)(?![a-z])"
    r"|(?<![A-Za-z0-9])[A-Za-z]_\w(?!\w)|(?<![A-Za-z0-9.])[A-Za-z][0-9](?![A-Za-z0-9])|\$|```"
)
# The texts of the page and of its elements, outside of formulas, code and quotations; what only
# screen readers read, or the search, is spoken.
_TEXTS: Final = """() => {
  const found = [];
  const walk = (node) => {
    if (node.nodeType === Node.TEXT_NODE) found.push(node.nodeValue);
    if (node.matches?.("math, code, q, script, style, .aloud, .words, .echo, .repair")) return;
    if (node.shadowRoot) walk(node.shadowRoot);
    node.childNodes.forEach(walk);
  };
  walk(document.body);
  return found;
}"""


def typed_names(page: Page) -> list[str]:
    """Return the texts of a page that contain a name such as theta1 as plain text."""
    return [text.strip() for text in page.evaluate(_TEXTS) if _TYPED.search(text)]
