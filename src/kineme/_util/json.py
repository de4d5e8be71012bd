"""Read JSON files safely, since people edit, copy and damage them.

Parsed content is nested at most `DEEPEST` levels, has only finite numbers in the range of floats,
and matches the requested type. Everything else raises ReadError. So callers need not handle
overflows or deep recursion.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any, TypeVar, overload

from kineme._util.files import AnyPath, refuse_pipe
from kineme.errors import ParameterError, ReadError

DEEPEST = 64
"""Largest nesting depth of lists and objects."""
LARGEST = sys.float_info.max
"""Largest absolute value of a number, also of integers."""
TOO_DEEP = f"nests more than {DEEPEST} lists and objects"

Shape = TypeVar("Shape")
Options = TypeVar("Options")


@overload
def load_json(path: Path) -> Any: ...
@overload
def load_json(path: Path, shape: type[Shape]) -> Shape: ...
def load_json(path: Path, shape: Any = Any) -> Any:
    """Read a JSON file, see `decode_json`; raise ReadError if it cannot be read."""
    try:
        refuse_pipe(path)
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ReadError(path, f"is not UTF-8 text (byte {error.start})") from error
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        reason = getattr(error, "strerror", None) or error
        raise ReadError(path, f"cannot be read: {reason}") from error
    return decode_json(text, path, shape)


@overload
def decode_json(text: str | bytes, path: AnyPath) -> Any: ...
@overload
def decode_json(text: str | bytes, path: AnyPath, shape: type[Shape]) -> Shape: ...
def decode_json(text: str | bytes, path: AnyPath, shape: Any = Any) -> Any:
    """Parse JSON and convert it to a type that msgspec supports; unknown names are dropped.

    Raise ReadError for ``path`` if it is invalid JSON, nested too deeply, has nan or too large
    numbers, or does not match the type.

    Examples
    --------
    >>> decode_json('{"offset_s": 2}', "walk.bvh.video.json", dict[str, float])
    {'offset_s': 2.0}
    """
    try:
        content = json.loads(text)
    except RecursionError as error:
        raise ReadError(path, TOO_DEEP) from error
    except ValueError as error:
        line = error.lineno if isinstance(error, json.JSONDecodeError) else None
        raise ReadError(path, "is not valid JSON or is truncated", line=line) from error
    if fault := find_fault(content):
        raise ReadError(path, fault)
    if shape is Any:
        return content
    try:
        return convert_json(content, shape)
    except ValueError as error:
        raise ReadError(path, f"has unexpected content: {error}") from error


def convert_json(content: Any, shape: type[Shape]) -> Shape:
    """Convert parsed JSON to a type that msgspec supports; raise ValueError on mismatch."""
    import msgspec  # not needed by `import kineme`

    try:
        return msgspec.convert(content, shape, str_keys=True)  # keys of JSON are texts
    except msgspec.ValidationError as error:
        raise ValueError(format_problem(str(error))) from error
    except ValueError as error:  # a lone surrogate in a name
        raise ValueError("a name is not text") from error


def format_problem(problem: str, everything: str = "the whole of it") -> str:
    """Rewrite a message of msgspec: location first, without backticks."""
    what, _, place = problem.partition(" - at ")
    where = re.sub(r"^`(key in )?\$\.?|`$", "", place) or everything
    return f"{where}: {what[:1].lower()}{what[1:].replace('`', '')}"


def options_to_json(options: object) -> dict[str, Any]:
    """Return the options in a dataclass that differ from their defaults, for JSON.

    Raise ParameterError for values that JSON cannot hold, such as arrays or custom presets.

    Examples
    --------
    >>> from kineme.formats import ReadOptions
    >>> options_to_json(ReadOptions(fps=30.0, columns=("acc_*",)))
    {'fps': 30.0, 'columns': ['acc_*']}
    """
    values, defaults = (
        json.loads(json.dumps(vars(each), default=_as_plain)) for each in (options, type(options)())
    )
    return {name: value for name, value in values.items() if value != defaults[name]}


def options_from_json(kind: type[Options], content: object) -> Options:
    """Return the options from the output of `options_to_json`, validated by their class.

    Raise ParameterError for an unknown option or an invalid value.

    Examples
    --------
    >>> from kineme.formats import ReadOptions
    >>> options_from_json(ReadOptions, {"columns": ["acc_*"]}).columns
    ('acc_*',)
    """
    if not isinstance(content, dict):
        raise ParameterError(f"options must be an object of names and values, not {content!r:.60}")
    names = vars(kind())
    if unknown := content.keys() - names:
        raise ParameterError(
            f"there is no option {min(unknown)!r:.60}; there are {', '.join(names)}"
        )
    return kind(**{name: _as_tuples(value) for name, value in content.items()})


def _as_plain(value: object) -> Any:
    if isinstance(value, PathLike):
        return fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise ParameterError(f"options must be names, numbers or texts, not {value!r:.60}")


def _as_tuples(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _as_tuples(item) for name, item in value.items()}
    return tuple(map(_as_tuples, value)) if isinstance(value, list) else value


def find_fault(content: Any) -> str:
    """Return why parsed JSON is unacceptable; empty if it is valid."""
    level: list[Any] = [[content]]
    # Go level by level, since recursion would fail on deep content.
    for _ in range(DEEPEST + 1):
        inner: list[Any] = []
        for container in level:
            for value in container:
                kind = type(value)
                if kind is dict:
                    inner.append(value.values())
                elif kind is list:
                    inner.append(value)
                elif (kind is float or kind is int) and not -LARGEST <= value <= LARGEST:
                    # `not ... <=` also catches nan, for which every comparison is False.
                    return "holds a number that is not finite or is too large"
        if not inner:
            return ""
        level = inner
    return TOO_DEEP
