"""What all routes share: bodies, problems, and layers around the application."""
