"""Deep linking: a tutor chooses exercises on our page, and the platform makes links of them."""
