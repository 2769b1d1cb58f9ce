"""Measure the program's speed and compare it with limits: ``python -m tests.benchmarks``."""
