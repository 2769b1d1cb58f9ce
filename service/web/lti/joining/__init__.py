"""The pages on which the admin of a platform registers it by invitation."""
