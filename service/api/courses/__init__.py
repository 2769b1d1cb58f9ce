"""The routes of courses: for tutors, and for learners with a link or a token."""
