"""Helpers of several formats: submissions with their reports, messages in words, escaping."""
