"""The HTTP interface: routes that read requests and send responses."""
