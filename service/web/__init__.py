"""The page and the element that other sites embed: HTML from here, everything else static files."""

from service.web.routes import web_routes

__all__ = ["web_routes"]
