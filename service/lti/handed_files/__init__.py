"""Grade files that students hand in at a platform, and report there (Asset Processor)."""
