"""Help for students: what they may type and paste, and how they earn points."""
