"""The pages of tutors."""
