"""What several formats share: submissions with their reports, messages in words, escaping."""
