"""The headers of the pages: what a browser may load and run there."""

from typing import Final


def policy(**more: str) -> str:
    """The policy of a page; ``more`` are directives that take the place of the usual ones.

    Nothing from another host, no script or style in the page itself, and no text that becomes
    markup but by the one policy of markup.js.
    """
    directives = {
        "default_src": "'none'",
        "script_src": "'self'",
        "style_src": "'self'",
        "img_src": "'self'",
        "connect_src": "'self'",
        "base_uri": "'none'",
        "form_action": "'self'",
        "frame_ancestors": "'self'",
        "require_trusted_types_for": "'script'",
        "trusted_types": "dh-grader",
        **more,
    }
    return "; ".join(f"{name.replace('_', '-')} {value}" for name, value in directives.items())


PAGE_HEADERS: Final = {
    "Content-Security-Policy": policy(),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Cache-Control": "no-cache",
}
# What only a tutor may see is kept by no browser.
NO_STORE: Final = {"Cache-Control": "no-store"}
PRIVATE_HEADERS: Final = {**PAGE_HEADERS, **NO_STORE}
