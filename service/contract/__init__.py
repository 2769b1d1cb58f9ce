"""The bodies that go over HTTP besides submissions and reports; the API writes, clients read."""
