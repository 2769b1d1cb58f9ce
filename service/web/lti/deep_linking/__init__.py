"""The page on which a tutor chooses exercises for links of the platform (deep linking)."""
