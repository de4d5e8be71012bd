"""Command line: ``kineme segment``, ``kineme info``, ``kineme demo``.

Exit codes: 0; 1 for bad input, with one sentence on standard error; 2 for invalid usage; 130 after
Ctrl+C. If one of several files fails, the others are still processed.
"""

import errno
import os
import sys

WRITE_ERRORS = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO})
"""Errors on writing output to a file that are reported without a traceback."""
PATH_ERRORS = frozenset({errno.ENAMETOOLONG, errno.EACCES})
"""Errors on looking up a path that are reported without a traceback."""


def main() -> None:
    """Run the command line."""
    try:
        try:
            _run()
        finally:
            # If Ctrl+C arrives while `exec` runs a string (as dataclasses do), ``python -m`` ends
            # by the signal and ignores the exit code. Executing another string resets this.
            exec("")  # noqa: S102
            sys.stdout.flush()
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:
        if error.errno in PATH_ERRORS and error.filename:
            from kineme.cli.terminal import print_error

            print_error(f"{error.filename}: {error.strerror}")
            sys.exit(1)
        if error.errno not in WRITE_ERRORS:
            raise
        # The flush at exit must not fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.stderr.write(f"error: output cannot be written: {error.strerror}\n")
        sys.exit(1)


def _run() -> None:
    from kineme.cli.app import app
    from kineme.cli.terminal import shorten_warnings

    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")
    shorten_warnings()
    app(prog_name="kineme")
