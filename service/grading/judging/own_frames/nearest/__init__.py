"""The valid table nearest to a wrong one."""
