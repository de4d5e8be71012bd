"""Command line: ``kineme segment``, ``kineme info``, ``kineme demo``.

Exit codes: 0; 1 for bad input, with one sentence on standard error; 2 for a
command that makes no sense; 130 after Ctrl-C. With several files, one that
fails does not stop the others.
"""

import errno
import os
import sys

FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO})
"""Why what is printed cannot be written, where it goes to a file."""


def main() -> None:
    """Run the command line."""
    try:
        try:
            _run()
        finally:
            # Where Ctrl+C fell into a string that was being executed (dataclasses do so), Python
            # ends by the signal under ``-m``, whatever exit code it is given. Executing another
            # string makes it forget that.
            exec("")  # noqa: S102
            sys.stdout.flush()
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:
        if error.errno not in FULL:
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the last flush
        sys.stderr.write(f"error: what is printed cannot be written: {error.strerror}\n")
        sys.exit(1)


def _run() -> None:
    from kineme.cli.app import app
    from kineme.cli.messages import shorten_warnings

    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")
    shorten_warnings()
    app(prog_name="kineme")
