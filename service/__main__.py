"""`python -m service` is `dh-grader`."""

from service.cli import main

if __name__ == "__main__":
    main()
