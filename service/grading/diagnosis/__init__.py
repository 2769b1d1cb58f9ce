"""Misconceptions: small pure functions, each asking whether one belief explains a wrong answer."""
