"""Help for students, in their language: what they may type and paste, and how they earn points."""
