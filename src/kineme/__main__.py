"""``python -m kineme``: the console script."""

from kineme.cli import main

main()
