"""JSON that lies beside recordings, which people edit, copy and damage: the one reader of it.

What comes out is no deeper than `DEEPEST`, has finite numbers that a float can hold, and is of the
shape that was asked for. Everything else is a ReadError. So what uses it need not expect that a
number overflows or a walk through it recurses too far.
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
"""Lists and objects inside one another."""
LARGEST = sys.float_info.max
"""Of any number; whole ones beyond are none that can be computed with."""
TOO_DEEP = f"holds more than {DEEPEST} lists and objects inside one another"

Shape = TypeVar("Shape")
Options = TypeVar("Options")


@overload
def load_json(path: Path) -> Any: ...
@overload
def load_json(path: Path, shape: type[Shape]) -> Shape: ...
def load_json(path: Path, shape: Any = Any) -> Any:
    """Return what a JSON file holds, as `decode_json`; ReadError where it cannot be read."""
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
    """What a JSON text of this path holds, in a shape that msgspec knows; other names are left out.

    ReadError where it is no JSON, holds too much inside one another, or numbers that are none or
    too large, or is of another shape.

    Examples
    --------
    >>> decode_json('{"offset_s": 2}', "walk.bvh.video.json", dict[str, float])
    {'offset_s': 2.0}
    """
    try:
        found = json.loads(text)
    except RecursionError as error:
        raise ReadError(path, TOO_DEEP) from error
    except ValueError as error:
        line = error.lineno if isinstance(error, json.JSONDecodeError) else None
        raise ReadError(path, "is not valid JSON, or is cut short", line=line) from error
    if fault := find_fault(found):
        raise ReadError(path, fault)
    if shape is Any:
        return found
    try:
        return convert_json(found, shape)
    except ValueError as error:
        raise ReadError(path, f"is not as it was written: {error}") from error


def convert_json(found: Any, shape: type[Shape]) -> Shape:
    """What JSON holds, in a shape that msgspec knows; ValueError in words where it has another."""
    import msgspec  # which `import kineme` does without

    try:
        return msgspec.convert(found, shape, str_keys=True)  # as JSON has them
    except msgspec.ValidationError as error:
        raise ValueError(format_problem(str(error))) from error
    except ValueError as error:  # half of a pair of surrogates for a name
        raise ValueError("a name is no text") from error


def format_problem(problem: str, everything: str = "the whole of it") -> str:
    """Return what msgspec says of a shape, with the place first and no signs of its own."""
    what, _, place = problem.partition(" - at ")
    where = re.sub(r"^`(key in )?\$\.?|`$", "", place) or everything
    return f"{where}: {what[:1].lower()}{what[1:].replace('`', '')}"


def options_to_json(options: object) -> dict[str, Any]:
    """Return the options of a dataclass that differ from their defaults, as JSON holds them.

    ParameterError for a value that JSON cannot hold, such as an array or a preset of one's own.

    Examples
    --------
    >>> from kineme.formats import ReadOptions
    >>> options_to_json(ReadOptions(fps=30.0, columns=("acc_*",)))
    {'fps': 30.0, 'columns': ['acc_*']}
    """
    given, defaults = (
        json.loads(json.dumps(vars(each), default=_as_plain)) for each in (options, type(options)())
    )
    return {name: value for name, value in given.items() if value != defaults[name]}


def options_from_json(kind: type[Options], content: object) -> Options:
    """Return the options that `options_to_json` gave, checked as all others of their kind.

    ParameterError where there is no such option, or it does not take this value.

    Examples
    --------
    >>> from kineme.formats import ReadOptions
    >>> options_from_json(ReadOptions, {"columns": ["acc_*"]}).columns
    ('acc_*',)
    """
    if not isinstance(content, dict):
        raise ParameterError(f"options must be values by their names, not {content!r:.60}")
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
    raise ParameterError(f"options are kept as names, numbers and texts, not as {value!r:.60}")


def _as_tuples(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _as_tuples(item) for name, item in value.items()}
    return tuple(map(_as_tuples, value)) if isinstance(value, list) else value


def find_fault(found: Any) -> str:
    """Return what of JSON no reader takes, in words; empty where it is sound."""
    level: list[Any] = [[found]]
    # Level by level instead of by recursion, which deep content would exhaust.
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
                    return "holds a number that is none, or too large"
        if not inner:
            return ""
        level = inner
    return TOO_DEEP
