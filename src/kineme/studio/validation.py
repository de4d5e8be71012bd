"""What a page sends, held against the message types: the value as it is, or a refusal.

Nothing is converted but whole numbers where a fraction would do; names that a
message does not have are refused, as is anything that JSON has no word for.
"""

from __future__ import annotations

import json
import math
from types import UnionType
from typing import (
    Any,
    Literal,
    NotRequired,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    is_typeddict,
)

from kineme.errors import ParameterError

LONGEST_TEXT = 500
"""Characters; nobody names a movement with more."""
LARGEST = 2**53
"""Whole numbers up to here are the same in the page and in Python."""


def parsed(body: bytes) -> Any:
    """The JSON value in a body.

    Raises
    ------
    ParameterError : not UTF-8, not JSON, nested too deeply, or with NaN or infinity
    """
    try:
        return json.loads(body.decode("utf-8"), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ParameterError("the request does not hold JSON") from error


def checked(kind: Any, value: Any, where: str = "the request") -> Any:
    """``value`` if it is of a message type.

    Parameters
    ----------
    kind : a ``TypedDict``, a union of such told apart by ``kind``, or what their fields hold
    where : the value's name in messages

    Raises
    ------
    ParameterError : it is not, and why
    """
    origin = get_origin(kind)
    if origin in (Union, UnionType):
        return checked(_alternative(kind, value, where), value, where)
    if is_typeddict(kind):
        return _dictionary(kind, value, where)
    if origin is Literal:
        if value not in get_args(kind) or not isinstance(value, str):
            raise ParameterError(f"{where} must be {' or '.join(get_args(kind))}")
        return value
    if origin is dict:
        if not isinstance(value, dict):
            raise ParameterError(f"{where} must be an object")
        inner = get_args(kind)[1]
        return {name: checked(inner, item, f"{where}.{name:.40}") for name, item in value.items()}
    return _plain(kind, value, where)


def _dictionary(kind: Any, value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ParameterError(f"{where} must be an object")
    # Read from the hints themselves: the keys a class says it requires ignore texts.
    hints = get_type_hints(kind, include_extras=True)
    for name, hint in hints.items():
        if name not in value and get_origin(hint) is not NotRequired:
            raise ParameterError(f"{where} has no {name!r}")
    for name in value.keys() - hints.keys():
        raise ParameterError(f"{where} may not have {name!r:.40}")
    bare = get_type_hints(kind)
    return {name: checked(bare[name], item, name) for name, item in value.items()}


def _alternative(kinds: Any, value: Any, where: str) -> Any:
    """The message of the union that calls itself what the value does."""
    by_name = {get_args(get_type_hints(kind)["kind"])[0]: kind for kind in get_args(kinds)}
    name = value.get("kind") if isinstance(value, dict) else None
    if not isinstance(name, str) or name not in by_name:
        raise ParameterError(f"{where} must be an object whose 'kind' is {', '.join(by_name)}")
    return by_name[name]


def _plain(kind: Any, value: Any, where: str) -> Any:
    if kind is float and type(value) in (int, float) and abs(value) < LARGEST:
        return float(value)
    if type(value) is not kind or (kind is float and not math.isfinite(value)):
        words = {int: "a whole number", float: "a number", str: "a text", bool: "true or false"}
        raise ParameterError(f"{where} must be {words[kind]}")
    if kind is int and abs(value) >= LARGEST:
        raise ParameterError(f"{where} is too large")
    if kind is str and len(value) > LONGEST_TEXT:
        raise ParameterError(f"{where} is longer than {LONGEST_TEXT} characters")
    return value


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is not JSON")
