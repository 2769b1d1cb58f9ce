"""`python -m service` runs the command `dh-grader`."""

from dh_grader.cli import main

if __name__ == "__main__":
    main()
