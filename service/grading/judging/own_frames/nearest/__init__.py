"""Find the valid table (one that describes the robot) nearest to a wrong one."""
