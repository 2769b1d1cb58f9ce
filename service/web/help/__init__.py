"""Help for students, in their language: what they may type and paste, and how points come about."""
