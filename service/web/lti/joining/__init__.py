"""The pages on which a platform's admin registers the platform by invitation."""
