"""Rigid transforms and Denavit-Hartenberg chains, batched. Independent of students' answers."""
