"""Rigid transforms and Denavit-Hartenberg chains, computed for whole arrays at once."""
