"""Register platforms: by invitation (dynamic registration), or with a file about this service."""
