"""What every reader shares: any surprise inside is one ReadError with its cause."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from kineme._files import refuse_pipe
from kineme.errors import FileError, KinemeError, ReadError


@contextmanager
def reading(path: str | os.PathLike[str]) -> Iterator[None]:
    """A block that reads a file: it ends well, or in an error of the package.

    Readers check what they can say something useful about; this is for the rest.
    Numbers too large to compute with are refused by what is made of them, so numpy
    need not warn of them.

    Raises
    ------
    ReadError
        In place of any exception but the package's own; the cause is kept.
    """
    try:
        refuse_pipe(path)
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            yield
    except KinemeError as error:
        if isinstance(error, FileError | ImportError) or not isinstance(error, ValueError):
            raise
        raise ReadError(path, str(error)) from error
    except OSError as error:
        raise ReadError(path, f"cannot be read: {error.strerror or _short(error)}") from error
    except UnicodeDecodeError as error:
        encoding = error.encoding.upper()
        raise ReadError(path, f"is not {encoding} text (byte {error.start})") from error
    except MemoryError as error:
        raise ReadError(
            path, "needs more memory than there is: it is damaged, or cut it"
        ) from error
    except RecursionError as error:
        raise ReadError(path, "holds too much inside one another: it is damaged") from error
    except Exception as error:
        message = _short(error)
        reason = f"{type(error).__name__}: {message}" if message else type(error).__name__
        raise ReadError(path, f"cannot be understood, it is damaged ({reason})") from error


def _short(error: Exception) -> str:
    """What an exception of another package says, on one line."""
    return " ".join(str(error).split())[:120]
