"""Grade files that students hand in at a platform, and send it reports (Asset Processor)."""
