"""The web pages of the service, and the exercise that other sites embed."""

from service.web.routes import web_routes
from service.web.tutor.tutor_routes import Tutoring

__all__ = ["Tutoring", "web_routes"]
