"""The commands `dh-grader lti`."""
