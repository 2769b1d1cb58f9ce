"""The page and the element that other sites embed: HTML from here, everything else static files."""

from service.web.routes import web_routes
from service.web.tutor.tutor_routes import Tutoring

__all__ = ["Tutoring", "web_routes"]
