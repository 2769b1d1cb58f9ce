"""The pages on which the admin of a learning platform registers the platform."""

# By invitation.
