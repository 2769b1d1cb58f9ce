"""Rigid transforms and Denavit-Hartenberg chains, batched. Knows nothing of students."""
