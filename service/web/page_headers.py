"""The HTTP headers of the pages, which limit what a browser may load and run."""

from typing import Final


def policy(**more: str) -> str:
    """Return the Content-Security-Policy of a page; ``more`` replaces some of its directives."""
    # It allows nothing from other hosts, and no script or style inside the page. Scripts may turn
    # text into markup only with the Trusted Types policy of markup.js.
    directives = {
        "default_src": "'none'",
        "script_src": "'self'",
        "style_src": "'self'",
        "img_src": "'self' blob:",
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
# Swagger UI makes markup from text, which "require-trusted-types-for" would forbid.
REFERENCE_HEADERS: Final = {
    **PAGE_HEADERS,
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
}
# Browsers must not store what only a tutor may see.
NO_STORE: Final = {"Cache-Control": "no-store"}
PRIVATE_HEADERS: Final = {**PAGE_HEADERS, **NO_STORE}
# A page without a referrer would send its forms without an origin.
FORM_HEADERS: Final = {**PRIVATE_HEADERS, "Referrer-Policy": "same-origin"}
