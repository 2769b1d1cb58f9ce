"""The HTTP interface: routes read requests, call the other packages, and send responses."""
