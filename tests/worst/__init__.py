"""Search for the requests that cost the most processor time."""
