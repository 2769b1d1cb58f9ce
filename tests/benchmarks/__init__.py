"""Measure the program and compare it with its budgets: ``python -m tests.benchmarks``."""
