"""Check arguments, format lists and counts, and register named objects."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib import import_module
from numbers import Real
from operator import index
from os import PathLike
from threading import RLock
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import KinemeWarning, MissingDependencyError, MotionError, ParameterError

MAX_FRAMES_RATIO = 1000
"""Largest ratio of a new to an old frame rate; above it the old rate is probably wrong."""
MANY = {"activity": "activities", "person": "people"}
"""Irregular plurals."""


@contextmanager
def require_extra(package: str, extra: str) -> Iterator[None]:
    """Raise MissingDependencyError if imports in the block fail; ``extra`` installs the package."""
    try:
        yield
    except ImportError as error:
        raise MissingDependencyError(package, extra) from error


def check_rates(old: float, new: float) -> None:
    """Raise ParameterError if resampling to a new rate would create too many frames."""
    if new > MAX_FRAMES_RATIO * old:
        raise ParameterError(
            f"frames {1 / old:g} s apart are too far for {new:g} frames per second: "
            "check the frame rate"
        )


def is_number(value: object) -> bool:
    """Return whether a value is a finite number in the range of floats."""
    try:
        return isinstance(value, Real) and math.isfinite(value)
    except OverflowError:
        return False


def is_whole_number(value: object, least: int) -> bool:
    """Return whether a value is a whole number, possibly a float, of at least ``least``."""
    if not (isinstance(value, Real) and is_number(value)):
        return False
    return float(value) >= least and float(value).is_integer()


def is_text(name: str) -> bool:
    """Return whether a name can be encoded as UTF-8, that is, has no lone surrogates."""
    return not any("\ud800" <= letter <= "\udfff" for letter in name)


def check_flag(value: object, name: str) -> None:
    """Raise ParameterError unless the value is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise ParameterError(f"{name} must be True or False, not {value!r:.60}")


def is_one_of(value: object, choices: Collection[str]) -> bool:
    """Return whether a value of any type is one of the texts."""
    return isinstance(value, str) and value in choices


def check_one_of(value: object, choices: Collection[str], what: str) -> None:
    """Raise ParameterError unless the value is one of the texts."""
    if not is_one_of(value, choices):
        raise ParameterError(f"{what} must be one of {', '.join(choices)}, not {value!r:.60}")


def check_type(
    value: object,
    kind: type | tuple[type, ...],
    caller: str,
    advice: str,
    *,
    error: type[ParameterError | MotionError] = ParameterError,
) -> None:
    """Raise ``error`` with advice if an argument of a public function has another type."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        expected = " or ".join(kind.__name__ for kind in kinds)
        if not expected.endswith("s"):  # no article before "Signals"
            expected = f"{'an' if expected[0] in 'AEIOU' else 'a'} {expected}"
        raise error(f"{caller} takes {expected}, not {type(value).__name__}: {advice}")


def check_path(path: object, caller: str) -> None:
    """Raise ParameterError if an argument of a public function is not a path."""
    check_type(path, (str, PathLike), caller, "give the path of a file")


def check_suffixes(suffixes: object, name: str) -> None:
    """Raise ParameterError unless suffixes are a tuple of lower-case texts with a dot."""
    if not (
        isinstance(suffixes, tuple)
        and suffixes
        and all(isinstance(s, str) and s.startswith(".") and s == s.lower() for s in suffixes)
    ):
        raise ParameterError(
            f"suffixes of {name!r:.60} must be a tuple in lower case with the dot, such as "
            f"('.xyz',), not {suffixes!r:.60}"
        )


def as_indices(values: Any, name: str) -> list[int]:
    """Return the values as integers; raise ParameterError if they are not."""
    try:
        return [index(value) for value in values]
    except TypeError:
        raise ParameterError(f"{name} must be whole numbers, not {values!r:.60}") from None


def as_texts(
    values: Any, name: str, *, error: type[ParameterError | MotionError] = ParameterError
) -> tuple[str, ...]:
    """Return the values as a tuple of texts; raise ``error`` for a single text or other types."""
    if isinstance(values, Iterable) and not isinstance(values, str):
        texts = tuple(values)
        if all(isinstance(value, str) for value in texts):
            return texts
    raise error(f"{name} must be a list of texts, not {values!r:.60}")


def as_spans(
    gaps: Any, *, error: type[ParameterError | MotionError] = ParameterError
) -> tuple[tuple[int, int], ...]:
    """Return gaps as pairs of frames (start, stop); raise ``error`` if they are not."""
    try:
        return tuple((index(start), index(stop)) for start, stop in gaps)
    except (TypeError, ValueError):
        raise error(f"gaps are pairs of frames (start, stop), not {gaps!r:.60}") from None


def as_floats(
    values: Any, name: str, *, error: type[ParameterError | MotionError] = ParameterError
) -> NDArray[np.float64]:
    """Return the values as a float64 array of any shape; raise ``error`` if not numbers."""
    try:
        array = np.asarray(values)
        if array.dtype.kind != "c":  # numpy would drop the imaginary parts
            return np.asarray(array, np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    description = repr(values) if isinstance(values, str) else type(values).__name__
    if isinstance(values, np.ndarray):
        description = f"{values.dtype} values"
    raise error(f"{name} must be an array of numbers, not {description:.60}") from None


def as_features(values: ArrayLike, name: str = "features") -> NDArray[np.float64]:
    """Return the values as a C-contiguous float64 array (frames, dims).

    Raise ParameterError unless finite.
    """
    # Compiled code is typed for writeable arrays.
    array = np.require(as_floats(values, name), requirements=("C", "W"))
    if array.ndim != 2 or 0 in array.shape:
        raise ParameterError(
            f"{name} must be frames x dims with at least one of each, not of shape {array.shape}"
        )
    if not np.isfinite(array).all():
        frame = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise ParameterError(f"{name} hold a value that is not finite, first in frame {frame}")
    return array


def format_count(n: int, one: str) -> str:
    """Return a number and a noun, in the plural if needed.

    Examples
    --------
    >>> format_count(1, "gap"), format_count(0, "gap"), format_count(2, "activity")
    ('1 gap', '0 gaps', '2 activities')
    """
    return f"{n} {one if n == 1 else MANY.get(one, f'{one}s')}"


def join_names(names: Sequence[str], most: int = 8) -> str:
    """Join the first names, and add the number of the others.

    Examples
    --------
    >>> join_names(["hip", "knee", "toe"], most=2), join_names(["hip", "knee"])
    ('hip, knee and 1 more', 'hip, knee')
    """
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def make_unique(names: Iterable[str], *, allow_empty: bool = False) -> list[str]:
    """Make names unique by appending a number to duplicates.

    Empty names get a number, too, unless they are allowed.

    Examples
    --------
    >>> make_unique(["hip", "knee", "hip", ""])
    ['hip', 'knee', 'hip_2', '_2']
    """
    distinct: dict[str, None] = {}
    last_numbers: dict[str, int] = {}  # the last number behind each name
    for name in names:
        new = name
        while new in distinct or not (new or allow_empty):
            last_numbers[name] = last_numbers.get(name, 1) + 1
            new = f"{name}_{last_numbers[name]}"
        distinct[new] = None
    return list(distinct)


class Named(Protocol):
    """Any object with a name."""

    @property
    def name(self) -> str: ...


T = TypeVar("T", bound=Named)


class Registry(Mapping[str, T]):
    """Objects of one kind by their names.

    A name cannot be registered twice unless the new object replaces the old one. ``what`` is the
    noun for an object in messages. Built-in objects are named as ``module:NAME``, relative to the
    package ``home``; NAME is one object or a tuple. Other packages add objects through the entry
    point group ``group``; those that fail to load are skipped with a `KinemeWarning`. With
    ``newest_first``, objects that are added later come before the others.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> tools = Registry(SimpleNamespace, "tool", "example.tools")
    >>> tools.register(SimpleNamespace(name="saw", teeth=9))
    >>> list(tools), tools["saw"].teeth
    (['saw'], 9)
    >>> tools.register(SimpleNamespace(name="saw", teeth=12))
    Traceback (most recent call last):
    ...
    kineme.errors.ParameterError: a tool named 'saw' exists already: choose another name or ...
    >>> tools.register(SimpleNamespace(name="saw", teeth=12), replace=True)
    >>> tools["saw"].teeth
    12
    """

    def __init__(
        self,
        kind: type[Any],
        what: str,
        group: str,
        *,
        home: str = "",
        builtins: Sequence[str] = (),
        newest_first: bool = False,
    ) -> None:
        self._kind = kind
        self._what = what
        self._group = group
        self._home = home
        self._builtins = builtins
        self._newest_first = newest_first
        self._objects: dict[str, T] = {}
        self._lock = RLock()
        self._loading = self._loaded = False

    def register(self, new: T, *, replace: bool = False) -> None:
        """Add an object; raise ParameterError if its name is taken or it has another type."""
        self._load()
        self._add(new, replace=replace)

    def remove(self, name: str) -> None:
        """Remove an object; raise KeyError if there is none with this name."""
        self._load()
        del self._objects[name]

    def __getitem__(self, name: str) -> T:
        self._load()
        return self._objects[name]

    def __iter__(self) -> Iterator[str]:
        self._load()
        return iter(self._objects)

    def __len__(self) -> int:
        self._load()
        return len(self._objects)

    def __repr__(self) -> str:
        return f"<{self._what}s: {', '.join(self)}>"

    def _add(self, new: T, *, replace: bool = False) -> None:
        """Add an object, in place of one of its name if ``replace``."""
        check_type(
            new, self._kind, "register", f"see {self._kind.__module__}.{self._kind.__name__}"
        )
        if new.name in self._objects:
            if not replace:
                raise ParameterError(
                    f"a {self._what} named {new.name!r:.60} exists already: choose another "
                    "name or set replace=True"
                )
            self._objects[new.name] = new
        elif self._newest_first:
            self._objects = {new.name: new, **self._objects}
        else:
            self._objects[new.name] = new

    def _load(self) -> None:
        """Load built-in objects and plugins once.

        Modules that access the registry while they are loaded see the objects so far.
        """
        if self._loaded:
            return
        with self._lock:
            if self._loading:  # a recursive call, or loaded meanwhile by another thread
                return
            self._loading = True
            try:
                builtins = [
                    new for path in self._builtins for new in _load_objects(path, self._home)
                ]
                # Each is inserted at the front, so load them in reverse order.
                for new in reversed(builtins) if self._newest_first else builtins:
                    self._add(new)
                self._add_plugins()
                self._loaded = True
            except BaseException:
                # Reset after a failure, so that the next access tries again.
                self._objects, self._loading = {}, False
                raise

    def _add_plugins(self) -> None:
        """Add the objects of entry points; warn of those that cannot be loaded."""
        from importlib.metadata import entry_points  # slow to import

        for point in sorted(entry_points(group=self._group), key=lambda point: point.name):
            try:
                for new in _as_sequence(point.load()):
                    # Its module may have registered it.
                    if self._objects.get(getattr(new, "name", "")) is not new:
                        self._add(new)
            except Exception as error:  # noqa: BLE001 (plugins may raise anything)
                reason = f"{type(error).__name__}: {error}"
                warnings.warn(
                    f"{point.name!r} of {self._group} was skipped, since it cannot "
                    f"be loaded: {reason}",
                    KinemeWarning,
                    stacklevel=2,
                )


def _load_objects(path: str, home: str) -> Iterable[Any]:
    """Import the objects named by ``module:NAME``."""
    module, _, name = path.partition(":")
    return _as_sequence(getattr(import_module(f".{module}", home), name))


def _as_sequence(objects: Any) -> Iterable[Any]:
    return objects if isinstance(objects, tuple | list) else (objects,)


def warn(message: str) -> None:
    """Issue a `KinemeWarning` attributed to the calling line outside of kineme."""
    level, frame = 1, sys._getframe()  # noqa: SLF001
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("kineme."):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, KinemeWarning, stacklevel=level)
