"""Who may do what: keys with scopes, tokens of learners, limits on rates."""
