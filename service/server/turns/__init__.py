"""Fair scheduling of the requests of different clients."""
