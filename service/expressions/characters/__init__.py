"""Text as typed -> plain characters, each with its place in the text as typed."""
