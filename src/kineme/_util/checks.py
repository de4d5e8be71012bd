"""Check arguments, count in sentences, and register named objects."""

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
"""Frames at a new rate for one of the old, at most; beyond that the old one is wrong."""


@contextmanager
def require_extra(package: str, extra: str) -> Iterator[None]:
    """MissingDependencyError where the imports in it fail; the extra installs the package."""
    try:
        yield
    except ImportError as error:
        raise MissingDependencyError(package, extra) from error


def check_rates(old: float, new: float) -> None:
    """ParameterError where the frames at a new rate would be beyond all measure."""
    if new > MAX_FRAMES_RATIO * old:
        raise ParameterError(
            f"frames {1 / old:g} s apart are too far for {new:g} a second: is the frame rate right?"
        )


def is_number(value: object) -> bool:
    """Return whether it is one finite number, as large as a float can be."""
    try:
        return isinstance(value, Real) and math.isfinite(value)
    except OverflowError:
        return False


def is_text(name: str) -> bool:
    """Whether a name can be written as UTF-8; that of a file or a joint may hold half a pair."""
    return not any("\ud800" <= letter <= "\udfff" for letter in name)


def check_flag(value: object, name: str) -> None:
    """ParameterError unless the value is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise ParameterError(f"{name} must be True or False, not {value!r:.60}")


def is_one_of(value: object, choices: Collection[str]) -> bool:
    """Return whether it is one of the known texts; anything at all may be asked about."""
    return isinstance(value, str) and value in choices


def check_one_of(value: object, choices: Collection[str], what: str) -> None:
    """ParameterError unless it is one of the known texts."""
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
    """``error`` with advice where a public function was given something else."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        expected = " or ".join(kind.__name__ for kind in kinds)
        if not expected.endswith("s"):  # Signals are many
            expected = f"{'an' if expected[0] in 'AEIOU' else 'a'} {expected}"
        raise error(f"{caller} takes {expected}, not {type(value).__name__}: {advice}")


def check_path(path: object, caller: str) -> None:
    """ParameterError where a public function was given no path."""
    check_type(path, (str, PathLike), caller, "give the path of a file")


def check_suffixes(suffixes: object, name: str) -> None:
    """ParameterError unless a format's suffixes are as paths are compared with them."""
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
    """Return the values as whole numbers; ParameterError where they are not."""
    try:
        return [index(value) for value in values]
    except TypeError:
        raise ParameterError(f"{name} must be whole numbers, not {values!r:.60}") from None


def as_texts(
    values: Any, name: str, *, error: type[ParameterError | MotionError] = ParameterError
) -> tuple[str, ...]:
    """Return the values as texts; ``error`` where they are one text or something else."""
    if isinstance(values, Iterable) and not isinstance(values, str):
        found = tuple(values)
        if all(isinstance(value, str) for value in found):
            return found
    raise error(f"{name} must be a list of texts, not {values!r:.60}")


def as_spans(
    gaps: Any, *, error: type[ParameterError | MotionError] = ParameterError
) -> tuple[tuple[int, int], ...]:
    """Return the gaps as pairs of frames (start, stop); ``error`` where they are not."""
    try:
        return tuple((index(start), index(stop)) for start, stop in gaps)
    except (TypeError, ValueError):
        raise error(f"gaps are pairs of frames (start, stop), not {gaps!r:.60}") from None


def as_floats(
    values: Any, name: str, *, error: type[ParameterError | MotionError] = ParameterError
) -> NDArray[np.float64]:
    """Return the values as a float64 array, of any shape; ``error`` where they are not numbers."""
    try:
        given = np.asarray(values)
        if given.dtype.kind != "c":  # numpy would drop the imaginary parts
            return np.asarray(given, np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    shown = repr(values) if isinstance(values, str) else type(values).__name__
    if isinstance(values, np.ndarray):
        shown = f"{values.dtype} values"
    raise error(f"{name} must be an array of numbers, not {shown:.60}") from None


def as_features(values: ArrayLike, name: str = "features") -> NDArray[np.float64]:
    """Return the values as float64 (frames, dims) without gaps in memory.

    ParameterError unless finite.
    """
    # Compiled code is typed for arrays that may be written to, whether it does or not.
    array = np.require(as_floats(values, name), requirements=("C", "W"))
    if array.ndim != 2 or 0 in array.shape:
        raise ParameterError(
            f"{name} must be frames x dims with at least one of each, not of shape {array.shape}"
        )
    if not np.isfinite(array).all():
        frame = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise ParameterError(f"{name} hold a value that is not finite, first in frame {frame}")
    return array


MANY = {"activity": "activities", "person": "people"}


def format_count(n: int, one: str) -> str:
    """Return a number and a noun, which is given for one.

    Examples
    --------
    >>> format_count(1, "gap"), format_count(0, "gap"), format_count(2, "activity")
    ('1 gap', '0 gaps', '2 activities')
    """
    return f"{n} {one if n == 1 else MANY.get(one, f'{one}s')}"


def join_names(names: Sequence[str], most: int = 8) -> str:
    """Return the first names, and how many more there are.

    Examples
    --------
    >>> join_names(["hip", "knee", "toe"], most=2), join_names(["hip", "knee"])
    ('hip, knee and 1 more', 'hip, knee')
    """
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def unique(names: Iterable[str], *, allow_empty: bool = False) -> list[str]:
    """Return the names, those that repeat an earlier one with a number behind them.

    An empty name gets a number, too, unless it is allowed.

    Examples
    --------
    >>> unique(["hip", "knee", "hip", ""])
    ['hip', 'knee', 'hip_2', '_2']
    """
    distinct: dict[str, None] = {}
    tried: dict[str, int] = {}  # the last number behind each name
    for name in names:
        new = name
        while new in distinct or not (new or allow_empty):
            tried[name] = tried.get(name, 1) + 1
            new = f"{name}_{tried[name]}"
        distinct[new] = None
    return list(distinct)


class Named(Protocol):
    """What a registry holds: anything with a name."""

    @property
    def name(self) -> str: ...


T = TypeVar("T", bound=Named)


class Registry(Mapping[str, T]):
    """Objects of one kind by their names.

    A name that is taken stays with the object that has it, unless another is to replace it.

    Parameters
    ----------
    kind : type
        Of the objects.
    what : str
        What one of them is called in messages.
    group : str
        Entry points by which other packages name theirs, such as ``kineme.scores``. Each stands
        for one object or a tuple of them. What cannot be loaded or taken is left out, and a
        `KinemeWarning` names it.
    home : str
        The package that the names of ``builtins`` are relative to; a dot leads out of it.
    builtins : sequence of str
        The package's own, as ``module:NAME`` of one object or a tuple of them.
    newest_first : bool
        Whether objects that are added later stand ahead of the others.

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
    kineme.errors.ParameterError: there is a tool 'saw' already: take another, or replace=True
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
        """Add an object under its name; ParameterError where it is taken, or of another kind."""
        self._load()
        self._add(new, replace=replace)

    def remove(self, name: str) -> None:
        """Take an object out again; KeyError where there is none of this name."""
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
        check_type(
            new, self._kind, "register", f"see {self._kind.__module__}.{self._kind.__name__}"
        )
        if new.name in self._objects:
            if not replace:
                raise ParameterError(
                    f"there is a {self._what} {new.name!r:.60} already: take another, or "
                    f"replace=True"
                )
            self._objects[new.name] = new
        elif self._newest_first:
            self._objects = {new.name: new, **self._objects}
        else:
            self._objects[new.name] = new

    def _load(self) -> None:
        """Look up the package's own and those of other packages, once.

        What is loaded may ask for this registry in turn: it then sees what is there so far.
        """
        if self._loaded:
            return
        with self._lock:
            if self._loading:  # further up by this thread, or by another that is done by now
                return
            self._loading = True
            try:
                builtins = [new for path in self._builtins for new in _objects_at(path, self._home)]
                # Each is put in front, so the reversed order comes out right.
                for new in reversed(builtins) if self._newest_first else builtins:
                    self._add(new)
                self._add_plugins()
                self._loaded = True
            except BaseException:
                # A failed load leaves nothing behind, so that the next one starts anew.
                self._objects, self._loading = {}, False
                raise

    def _add_plugins(self) -> None:
        from importlib.metadata import entry_points  # slow to load: not before it is asked for

        for point in sorted(entry_points(group=self._group), key=lambda point: point.name):
            try:
                for new in _all_of(point.load()):
                    if self._objects.get(getattr(new, "name", "")) is not new:  # else by itself
                        self._add(new)
            except Exception as error:  # noqa: BLE001 (whatever a stranger's module raises)
                reason = f"{type(error).__name__}: {error}"
                warnings.warn(
                    f"{point.name!r} of {self._group} is left out, it cannot be loaded: {reason}",
                    KinemeWarning,
                    stacklevel=2,
                )


def _objects_at(path: str, home: str) -> Iterable[Any]:
    """Return the objects that ``module:NAME`` names."""
    module, _, name = path.partition(":")
    return _all_of(getattr(import_module(f".{module}", home), name))


def _all_of(found: Any) -> Iterable[Any]:
    return found if isinstance(found, tuple | list) else (found,)


def warn(message: str) -> None:
    """Warn (`KinemeWarning`) at the line outside the package from which it was called."""
    level, frame = 1, sys._getframe()  # noqa: SLF001
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("kineme."):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, KinemeWarning, stacklevel=level)
