"""The HTTP interface. Its routes read requests, call the other packages, and send responses."""
