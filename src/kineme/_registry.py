"""Registries: named objects of one kind, which other packages may add to.

Formats, label formats, presets and scores are each one `Registry`. Its objects come from three
places: the package names its own, other installed packages name theirs as entry points, and
programs add theirs with `Registry.register`. Nothing is imported before it is asked for.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from threading import RLock
from typing import Any, Protocol, TypeVar

from kineme._checks import check_type
from kineme.errors import KinemeWarning, ParameterError


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
        The package that the names of ``builtins`` are relative to.
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
                for new in reversed(builtins) if self._newest_first else builtins:
                    self._add(new)
                self._add_plugins()
                self._loaded = True
            except BaseException:
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
    return _all_of(getattr(import_module(f"{home}.{module}"), name))


def _all_of(found: Any) -> Iterable[Any]:
    return found if isinstance(found, tuple | list) else (found,)
