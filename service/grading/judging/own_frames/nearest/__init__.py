"""Find the valid table nearest to a wrong one."""
