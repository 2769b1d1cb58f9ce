"""The pages of courses, for tutors."""
