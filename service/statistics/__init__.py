"""The statistics of a class, counted from its reports."""

from service.statistics.class_statistics import ClassStatistics
from service.statistics.identical import IdenticalMistakes, MistakeGroup
from service.statistics.misconceptions import CountedSlip, SlipCounts
from service.statistics.scores import ScoreBin, ScoreDistribution
from service.statistics.success import CellSuccess, FrequentEntry, PartSuccess, RowSuccess, Share

__all__ = [
    "CellSuccess",
    "ClassStatistics",
    "CountedSlip",
    "FrequentEntry",
    "IdenticalMistakes",
    "MistakeGroup",
    "PartSuccess",
    "RowSuccess",
    "ScoreBin",
    "ScoreDistribution",
    "Share",
    "SlipCounts",
]
