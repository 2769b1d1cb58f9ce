"""Code that all routes share: request bodies, error responses, and layers of the application."""
