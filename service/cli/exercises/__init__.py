"""The subcommands of `dh-grader exercises`: check, import and export."""
