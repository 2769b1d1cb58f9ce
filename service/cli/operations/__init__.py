"""Commands for the people who keep an installation running."""
