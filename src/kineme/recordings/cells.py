"""Recognise numbers in cells of text, with a decimal point or comma."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from itertools import chain
from math import nan
from typing import Any

import numpy as np

from kineme._util.arrays import Floats
from kineme.recordings.column_names import EMPTY

COMMAS = "numbers have a decimal comma"
"""Note added if numbers have a decimal comma."""

_NUMBER = re.compile(r"\s*[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?\s*")
_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")


def is_number(cell: str) -> bool:
    """Return whether a cell is a number, with a decimal point or comma."""
    return bool(_NUMBER.fullmatch(cell))


def replace_decimal_comma(cell: str) -> str:
    """Return a number with a point instead of a decimal comma, and other text unchanged."""
    return cell.replace(",", ".") if _COMMA.fullmatch(cell) else cell


def has_decimal_comma(cells: Iterable[str]) -> bool:
    """Return whether numbers in the cells of a table have a decimal comma."""
    numbers = [cell for cell in cells if is_number(cell)]
    # A single number with a point shows that commas are no decimal commas.
    return not any("." in cell for cell in numbers) and any(map(_COMMA.fullmatch, numbers))


def parse_texts(columns: Mapping[int, Iterable[Any]]) -> tuple[dict[int, Floats], tuple[str, ...]]:
    """Return the columns of which all texts are numbers, NaN if empty, and notes.

    Examples
    --------
    >>> parse_texts({0: ["9,81", None], 2: ["left", "left"]})
    ({0: array([9.81,  nan])}, ('numbers have a decimal comma',))
    """
    texts = {i: [str(cell).strip() for cell in column] for i, column in columns.items()}
    empty = EMPTY | {"<na>"}  # NA of pandas
    filled = {i: [text for text in some if text.lower() not in empty] for i, some in texts.items()}
    numeric = {i: some for i, some in filled.items() if some and all(map(is_number, some))}
    has_comma = has_decimal_comma(chain(*numeric.values()))
    numbers = {}
    for i in numeric:
        cells = map(replace_decimal_comma, texts[i]) if has_comma else texts[i]
        # A column with commas beside one with points is no number.
        with suppress(ValueError):
            numbers[i] = np.array([nan if cell.lower() in empty else float(cell) for cell in cells])
    return numbers, (COMMAS,) if has_comma else ()
