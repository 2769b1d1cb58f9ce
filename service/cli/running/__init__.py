"""Long runs: several processes or threads, progress, interrupts."""
