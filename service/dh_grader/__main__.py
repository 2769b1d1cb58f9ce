"""`python -m dh_grader` runs the command `dh-grader`."""

from dh_grader.cli import main

if __name__ == "__main__":
    main()
