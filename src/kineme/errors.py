"""Define all exceptions and warnings of the package.

    Exception
      KinemeError
        FileError               a file, a line in it, and what is wrong there
          ReadError             cannot be read or understood
            SeveralPeopleError  one of several people is to be chosen
          WriteError            cannot be written
        MotionError             a motion or skeleton that contradicts itself
          EndEffectorError      head, hands or feet not found
        ParameterError          a value outside what a function accepts
        MissingDependencyError  an optional package is not installed
    UserWarning
      KinemeWarning             accepted, but worth knowing

Each message is one sentence that names the value seen and what to do. The
command line prints it and exits with code 1.
"""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike, fspath
from typing import Any


class KinemeError(Exception):
    """Base of every error raised on purpose; all of them can be pickled.

    Examples
    --------
    >>> import kineme
    >>> try:
    ...     kineme.read("nothing.bvh")
    ... except kineme.KinemeError as error:
    ...     print(type(error).__name__)
    ReadError
    """

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore_error, (type(self), self.args, vars(self))


class FileError(KinemeError):
    """What is wrong with a file: ``PATH, line N: reason``.

    Examples
    --------
    >>> from kineme.errors import FileError
    >>> print(FileError("walk.bvh", "no joints", line=2))
    walk.bvh, line 2: no joints
    """

    def __init__(self, path: str | PathLike[str], reason: str, *, line: int | None = None):
        try:
            self.path = fspath(path)
        except TypeError:  # a URL, as universal_pathlib has it
            self.path = str(path)
        self.reason = reason
        self.line = line
        where = self.path if line is None else f"{self.path}, line {line}"
        super().__init__(f"{where}: {reason}")


class ReadError(FileError):
    """Raised where a file cannot be read, or what it holds cannot be understood.

    Examples
    --------
    >>> import kineme
    >>> try:
    ...     kineme.read("nothing.bvh")
    ... except kineme.ReadError as error:
    ...     error.path
    'nothing.bvh'
    """


class SeveralPeopleError(ReadError):
    """Raised where a file holds several people and none was chosen; ``people`` are their names."""

    def __init__(self, path: str | PathLike[str], reason: str, people: Iterable[str]):
        self.people = tuple(people)
        super().__init__(path, reason)


class WriteError(FileError):
    """Raised where a file cannot be written; nothing was left behind.

    Examples
    --------
    >>> import kineme
    >>> try:
    ...     kineme.write(kineme.read(kineme.bundled_recording()), "walk.doc")
    ... except kineme.WriteError as error:
    ...     error.path
    'walk.doc'
    """


class LinkError(WriteError):
    """A file or folder that kineme would write is a link, and could lead elsewhere.

    Examples
    --------
    >>> from kineme.errors import LinkError, WriteError
    >>> issubclass(LinkError, WriteError)
    True
    """


class MotionError(KinemeError, ValueError):
    """A motion or skeleton whose parts contradict each other.

    Examples
    --------
    >>> import kineme
    >>> try:
    ...     kineme.Skeleton(["hip"], [3], [[0, 0, 0]])
    ... except kineme.MotionError as error:
    ...     print(error)
    joint 'hip' (index 0) has parent 3: parents come before their children, and a root has -1
    """


class EndEffectorError(MotionError):
    """Head, hands or feet were not found in the skeleton; ``reason`` is why, without advice.

    Examples
    --------
    >>> import kineme
    >>> skeleton = kineme.Skeleton(["ball"], [-1], [[0, 0, 0]])
    >>> try:
    ...     kineme.end_effectors(skeleton)
    ... except kineme.EndEffectorError as error:
    ...     print(error.reason)
    no left ankle, right ankle, head, left wrist or right wrist among the joints
    """

    def __init__(self, message: str, *, reason: str | None = None):
        self.reason = reason or message
        super().__init__(message)


class ParameterError(KinemeError, ValueError):
    """A parameter outside the values a function accepts.

    Examples
    --------
    >>> import kineme
    >>> try:
    ...     kineme.resample(kineme.read(kineme.bundled_recording()), -1)
    ... except kineme.ParameterError as error:
    ...     print(error)
    fps is -1: give frames per second, above 0
    """


class MissingDependencyError(KinemeError, ImportError):
    """An optional package is needed: ``pip install 'kineme[extra]'``.

    Examples
    --------
    >>> from kineme.errors import MissingDependencyError
    >>> print(MissingDependencyError("pandas", "tables"))
    this needs pandas, which is not installed: pip install 'kineme[tables]'
    """

    def __init__(self, package: str, extra: str):
        self.package = package
        self.extra = extra
        super().__init__(
            f"this needs {package}, which is not installed: pip install 'kineme[{extra}]'"
        )


class KinemeWarning(UserWarning):
    """Something unusual was accepted; the message says what was made of it.

    Examples
    --------
    >>> import warnings
    >>> import kineme
    >>> warnings.simplefilter("error", kineme.KinemeWarning)  # stop where something unusual is read
    """


def _restore_error(
    kind: type[KinemeError], args: tuple[Any, ...], state: dict[str, Any]
) -> KinemeError:
    """Restore a pickled error, also if its constructor takes other arguments than ``args``."""
    error = kind.__new__(kind, *args)
    vars(error).update(state)
    return error
