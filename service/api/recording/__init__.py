"""The routes for recorded attempts."""
