"""Submissions over HTTP or as files: read and validate them, and find their exercise."""
