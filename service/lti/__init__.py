"""LTI 1.3: platforms (learning management systems) launch courses and assignments."""
