"""Deep linking: a page on which a tutor chooses exercises, to make links on the platform."""
