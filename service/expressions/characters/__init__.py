"""What was typed -> plain characters that know where they were typed."""
