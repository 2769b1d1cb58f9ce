"""Authorization and rate limits: API keys with scopes, and tokens of learners."""
