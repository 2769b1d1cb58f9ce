"""What all routes share: bodies, problems, layers around the application."""
