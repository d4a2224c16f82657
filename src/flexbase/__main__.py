"""`python -m flexbase`: the command line."""

from flexbase.cli.main import main

if __name__ == "__main__":
    main()
