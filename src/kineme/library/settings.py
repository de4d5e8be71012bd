"""How the recordings of a library are read and segmented."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from functools import cached_property
from hashlib import sha256
from os import PathLike, fspath
from typing import Any

from kineme._version import __version__
from kineme.errors import ParameterError
from kineme.formats import ReadOptions
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.segments.hierarchy import DEFAULT_DETAIL, check_detail

ANALYSIS = "kineme.library.piece/4"
"""Schema of an analysis: a change of what is kept of a recording gets the next number."""


@dataclass(frozen=True)
class Settings:
    """How recordings are read and segmented.

    Parameters
    ----------
    preset : str
        Name of a preset.
    constants : Mapping of str to object
        Of the preset, where they are others.
    reading : Mapping of str to object
        Keywords of `kineme.read`, such as ``fps`` and ``unit``.
    effectors : mapping or sequence of str, optional
        Joints to take for head, hands and feet where names do not tell.
    detail : float
        Of the segments that are kept: 1 as found, less is coarser, more is finer.

    Raises
    ------
    ParameterError
        No such preset, constant, keyword or detail, or a value that it cannot take.

    Examples
    --------
    >>> Settings(constants={"min_action": 2.0}).constants["min_action"]
    2.0
    """

    preset: str = DEFAULT
    constants: Mapping[str, Any] = field(default_factory=dict)
    reading: Mapping[str, Any] = field(default_factory=dict)
    effectors: Mapping[str, str] | Sequence[str] | None = None
    detail: float = DEFAULT_DETAIL

    def __post_init__(self) -> None:
        if not isinstance(self.preset, str):
            raise ParameterError(f"a library takes the name of a preset, not {self.preset!r:.60}")
        mappings: dict[str, Any] = {"constants": self.constants, "reading": self.reading}
        for name, given in mappings.items():
            if not (isinstance(given, Mapping) and all(isinstance(key, str) for key in given)):
                raise ParameterError(f"{name} must be values by their names, not {given!r:.60}")
        resolve_preset(self.preset, **self.constants)
        check_detail(self.detail)
        self.options()

    def options(self) -> ReadOptions:
        """Those of the reader."""
        try:
            return ReadOptions(**self.reading)
        except TypeError:
            names = ", ".join(ReadOptions.__dataclass_fields__)
            raise ParameterError(
                f"recordings are read with {names}, not with {', '.join(self.reading)}"
            ) from None

    def to_json(self) -> dict[str, Any]:
        """Return what JSON can hold of them; ``Settings.from_json`` takes it back."""
        content: dict[str, Any] = json.loads(json.dumps(asdict(self), default=_plain))
        return content

    @classmethod
    def from_json(cls, content: Mapping[str, Any]) -> Settings:
        """Settings as `to_json` gave them.

        Raises
        ------
        ParameterError
            They are of another shape.
        """
        try:
            constants = {name: _as_tuple(value) for name, value in content["constants"].items()}
            reading = {name: _as_tuple(value) for name, value in content["reading"].items()}
            detail = content["detail"]
            preset = content["preset"]
            return cls(preset, constants, reading, content["effectors"], detail)
        except (KeyError, TypeError, AttributeError) as error:
            raise ParameterError(
                "the settings of the library are not as they were written: build it anew"
            ) from error

    def key(self, digest: str) -> str:
        """Return the name of the analysis of a recording whose files have this digest."""
        return sha256(f"{self._digest} {digest}".encode()).hexdigest()[:32]

    @cached_property
    def _digest(self) -> str:
        """Return a digest of the version and of everything that decides what is found."""
        presets = []
        for signals in (False, True):
            with suppress(ParameterError):  # constants of one that the other does not have
                chosen = resolve_preset(self.preset, signals=signals, **self.constants)
                presets.append([chosen.name, dict(chosen.parameters())])
        content = [ANALYSIS, __version__, presets, self.to_json()]
        return sha256(json.dumps(content, sort_keys=True, default=_plain).encode()).hexdigest()


def _plain(value: Any) -> Any:
    return fspath(value) if isinstance(value, PathLike) else list(value)


def _as_tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value
