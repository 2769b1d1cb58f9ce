"""Submissions, over HTTP or as files: read strictly, checked, their exercise found."""
