"""Convert messages to JSON and back, and check them against their types."""

from __future__ import annotations

from typing import Any, TypeVar

import msgspec

from kineme._util.json import format_problem
from kineme.errors import ParameterError

Message = TypeVar("Message")


def to_json(message: object) -> bytes:
    """Return a message as JSON; numbers that are not finite become null.

    Invalid Unicode in file names becomes "?".

    Examples
    --------
    >>> to_json({"score": float("nan")})
    b'{"score":null}'
    """
    try:
        return msgspec.json.encode(message)
    except UnicodeEncodeError:  # file names may contain arbitrary bytes
        return msgspec.json.encode(_replace_invalid_unicode(msgspec.to_builtins(message)))


def from_json(body: bytes, kind: type[Message]) -> Message:
    """Return the message in a request body.

    ParameterError names the field with a wrong type or a value out of range.

    Examples
    --------
    >>> from kineme.web.requests import CompareRequest
    >>> from_json(b'{"preset": "kineme"}', CompareRequest).preset
    'kineme'
    """
    try:
        return msgspec.json.decode(body, type=kind)
    except msgspec.ValidationError as error:
        raise ParameterError(format_problem(str(error), "the request")) from error
    except (ValueError, RecursionError) as error:  # ValueError: also what is not UTF-8
        raise ParameterError("the request does not hold JSON") from error


def _replace_invalid_unicode(value: Any) -> Any:
    if isinstance(value, str):
        return value.encode(errors="replace").decode()
    if isinstance(value, dict):
        return {
            _replace_invalid_unicode(name): _replace_invalid_unicode(item)
            for name, item in value.items()
        }
    return [_replace_invalid_unicode(item) for item in value] if isinstance(value, list) else value
