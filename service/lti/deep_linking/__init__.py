"""Deep linking: a tutor chooses exercises on our page, and the platform links to them."""
