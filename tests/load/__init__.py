"""Load tests with many clients."""
