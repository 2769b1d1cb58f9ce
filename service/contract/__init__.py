"""The HTTP bodies besides submissions and reports, for the API and its clients."""
