"""Whether an answer is of its message type, field by field."""

from __future__ import annotations

from types import NoneType
from typing import Any, Literal, NotRequired, get_args, get_origin, get_type_hints, is_typeddict


def conforms(kind: Any, value: Any) -> bool:
    origin, inner = get_origin(kind), get_args(kind)
    if is_typeddict(kind):
        hints = get_type_hints(kind, include_extras=True)
        needed = {name for name, hint in hints.items() if get_origin(hint) is not NotRequired}
        assert needed <= value.keys() <= hints.keys(), (kind.__name__, sorted(value))
        bare = get_type_hints(kind)
        assert all(conforms(bare[name], item) for name, item in value.items()), kind.__name__
        return True
    if origin is Literal:
        return value in inner
    if origin is list:
        return isinstance(value, list) and all(conforms(inner[0], item) for item in value)
    if origin is tuple:
        return len(value) == len(inner) and all(map(conforms, inner, value))
    if origin is dict:
        return isinstance(value, dict) and all(conforms(inner[1], v) for v in value.values())
    if origin is not None:
        return any(conforms(member, value) for member in inner)
    if kind is Any:
        return True
    if kind is float:
        return type(value) in (int, float)
    return value is None if kind is NoneType else type(value) is kind
