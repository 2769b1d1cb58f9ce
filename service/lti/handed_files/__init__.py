"""Files that students hand in at the platform: graded here, reported there (Asset Processor)."""
