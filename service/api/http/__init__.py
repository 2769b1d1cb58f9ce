"""Code that all routes share: request bodies, error responses and middleware."""
