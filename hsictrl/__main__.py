"""``python -m hsictrl`` is the command ``hsictrl``."""

from hsictrl.cli import main

if __name__ == "__main__":
    main()
