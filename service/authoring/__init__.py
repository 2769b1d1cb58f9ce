"""Remarks for the author of an exercise, before students see it."""

from service.authoring.examine import examine
from service.authoring.lazy import lazy_shares
from service.authoring.remarks import Level, Remark
from service.authoring.template import UnusableIdError, template

__all__ = ["Level", "Remark", "UnusableIdError", "examine", "lazy_shares", "template"]
