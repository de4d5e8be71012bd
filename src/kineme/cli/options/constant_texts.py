"""Values of constants as they are typed and shown: ``0.5``, ``none``, ``yes``, ``1,1 2,1``."""

from __future__ import annotations

from types import NoneType
from typing import Any, Literal, get_args, get_origin

from kineme.errors import ParameterError


def parsed(hint: Any, text: str) -> Any:
    """A text as a value of one of the types that constants have.

    Parameters
    ----------
    hint : type
        Of the constant.
    text : str

    Raises
    ------
    ParameterError
        It is none.

    Examples
    --------
    >>> parsed(float | None, "none"), parsed(tuple[float, ...], "-0.1,0,0.1")
    (None, (-0.1, 0.0, 0.1))
    """
    try:
        return _value(hint, text.strip())
    except (ValueError, KeyError):
        raise ParameterError(f"{text!r} is not {metavar(hint)}") from None


def shown(value: Any) -> str:
    """A value as it would be typed, numbers to four digits.

    Examples
    --------
    >>> shown(((1, 1), (2, 1))), shown(None), shown(True), shown(1 / 3)
    ('1,1 2,1', 'none', 'yes', '0.3333')
    """
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        between = " " if value and isinstance(value[0], tuple) else ","
        return between.join(map(shown, value))
    if isinstance(value, float):
        return f"{value:.4g}"
    return "none" if value is None else str(value)


def metavar(hint: Any) -> str:
    """What stands for a value of a type in the help.

    Examples
    --------
    >>> metavar(float), metavar(int | None), metavar(tuple[int, int])
    ('NUMBER', 'COUNT|none', 'COUNT,COUNT')
    """
    members = get_args(hint)
    if NoneType in members:
        return f"{metavar(_without_none(hint))}|none"
    if get_origin(hint) is Literal:
        return "|".join(members)
    if get_origin(hint) is tuple:
        if get_origin(members[0]) is tuple:
            return '"A,B A,B …"'
        known = [metavar(member) for member in members if member is not Ellipsis]
        return ",".join([*known, *known, "…"] if Ellipsis in members else known)
    return {int: "COUNT", float: "NUMBER", bool: "yes|no"}.get(hint, "TEXT")


def _value(hint: Any, text: str) -> Any:
    members = get_args(hint)
    if NoneType in members:
        return None if text.lower() == "none" else _value(_without_none(hint), text)
    if get_origin(hint) is Literal:
        return {str(member): member for member in members}[text]
    if get_origin(hint) is tuple:
        parts = text.split() if get_origin(members[0]) is tuple else text.split(",")
        return tuple(_value(members[0], part) for part in parts)
    if hint is bool:
        return {"true": True, "yes": True, "false": False, "no": False}[text.lower()]
    return hint(text)


def _without_none(hint: Any) -> Any:
    return next(member for member in get_args(hint) if member is not NoneType)
