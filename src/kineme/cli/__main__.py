"""``python -m kineme.cli``: the console script."""

from kineme.cli import main

main()
