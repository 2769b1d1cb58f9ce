"""Robots drawn by a grammar of axis relations: a level and a seed -> an exercise."""
