"""Checks of an exercise for its author, before students see it, and a template for a new one."""

from service.authoring.examine import examine, failures
from service.authoring.lazy import summary
from service.authoring.remarks import Level, Remark
from service.authoring.template import UnusableIdError, template

__all__ = ["Level", "Remark", "UnusableIdError", "examine", "failures", "summary", "template"]
