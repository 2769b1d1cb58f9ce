"""`python -m service` runs the command `dh-grader`."""

from service.cli import main

if __name__ == "__main__":
    main()
