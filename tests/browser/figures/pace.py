"""Measure the work of a page that draws an animation."""

# The work is the number of passes over the styles, and the processor time of scripts. The number of
# pictures per second depends on other programs on the machine, so this number is only printed.

from typing import Final, NamedTuple

from playwright.sync_api import Locator

# Ten times what the slowest run needed: a guard against scripts that keep the page busy.
MOST_SCRIPT_MS: Final = 40.0

_PICTURES: Final = """async (element, move) => {
  const moved = move && (0, eval)(move);
  const from = performance.now();
  let count = 0;
  for (let now = from; now < from + 1000; now = performance.now(), count++) {
    moved?.(element, (now - from) / 1000);
    await new Promise((done) => requestAnimationFrame(done));
  }
  return count;
}"""


class Pace(NamedTuple):
    """The number of pictures in one second, and how much the page worked to draw them."""

    pictures: int
    style_passes: float
    script_ms: float

    def __str__(self) -> str:
        return f"{self.pictures} pictures a second, {self.script_ms:.1f} ms of script for each"


def pace(element: Locator, move: str | None = None) -> Pace:
    """Measure the page's work while it draws pictures for one second."""
    # Args:
    #     element: An element of the page.
    #     move: A JavaScript function that changes the element before each picture. It gets the
    #         element and the seconds since the start.
    session = element.page.context.new_cdp_session(element.page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})

    def metrics() -> dict[str, float]:
        found = session.send("Performance.getMetrics")["metrics"]
        return {each["name"]: each["value"] for each in found}

    before = metrics()
    pictures = element.evaluate(_PICTURES, move)
    after = metrics()
    session.detach()
    passes, script = (after[name] - before[name] for name in ("RecalcStyleCount", "ScriptDuration"))
    return Pace(pictures, passes, 1000 * script / pictures)
