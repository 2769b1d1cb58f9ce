"""The processes that serve one port."""
