"""The command line: ``kineme segment``, ``kineme info``, ``kineme demo``.

Exit codes: 0; 1 for bad input, with one sentence on standard error; 2 for a
command that makes no sense; 130 after Ctrl-C. With several files, one that
fails does not stop the others.
"""

import sys


def main() -> None:
    """The console script."""
    try:
        from kineme.cli.app import app
        from kineme.cli.messages import short_warnings

        if hasattr(sys.stdout, "reconfigure"):
            sys.stdout.reconfigure(errors="backslashreplace")
        short_warnings()
        app(prog_name="kineme")
    except KeyboardInterrupt:
        sys.exit(130)
