"""Compiled parser of AMC text. ``tests/helpers/naive`` has a simple equivalent."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

TENS = 10.0 ** np.arange(23)  # powers of ten that are exact as float64

EXACT = 1 << 53  # integers up to this are exact as float64
SPACE, PLUS, MINUS, POINT, ZERO, NINE = 32, 43, 45, 46, 48, 57
NOT_HERE = -1


@njit("int64(uint8[::1], int64)", **OPTIONS)
def find_word(text, offset):
    """Return the start of the next word or the end of the text; `NOT_HERE` if no space precedes."""
    before = offset
    while offset < len(text) and (text[offset] == SPACE or 9 <= text[offset] <= 13):
        offset += 1
    return offset if offset > before else NOT_HERE


@njit("int64(uint8[::1], int64, uint8[::1])", **OPTIONS)
def skip_name(text, offset, name):
    """Return the end of a name that starts here; `NOT_HERE` if another word does."""
    if offset + len(name) > len(text):
        return NOT_HERE
    for i in range(len(name)):
        if text[offset + i] != name[i]:
            return NOT_HERE
    return offset + len(name)


@njit("int64(uint8[::1], int64, float64[::1])", **OPTIONS)
def parse_number(text, offset, value):
    """Return the end of a number that starts here, and store its value.

    Return `NOT_HERE` if there is none, or if dividing an integer by a power of ten may round
    differently from ``float``.
    """
    negative = offset < len(text) and text[offset] == MINUS
    if negative or (offset < len(text) and text[offset] == PLUS):
        offset += 1
    mantissa, digits, decimals, point = 0, 0, 0, False
    while offset < len(text):
        sign = text[offset]
        if ZERO <= sign <= NINE:
            mantissa = 10 * mantissa + (sign - ZERO)
            digits += 1
            decimals += point
            # For larger numbers the quotient may round differently from `float`.
            if mantissa >= EXACT or digits == len(TENS):
                return NOT_HERE
        elif sign == POINT and not point:
            point = True
        else:
            break
        offset += 1
    value[0] = mantissa / TENS[decimals]
    if negative:
        value[0] = -value[0]
    return offset if digits else NOT_HERE


@njit("int64(uint8[::1], uint8[::1], int64[::1], int64[::1], float64[:, ::1])", **OPTIONS)
def read_rows(text, names, ends, counts, rows):
    """Parse frames into rows: the number of the frame, then the values of each bone.

    A frame is its number and, for each bone, its name (``names`` up to its end) and its values. The
    text must start and end with a space, and ``rows`` be large enough. Return the number of frames,
    or `NOT_HERE` if the text has another layout.
    """
    offset, row, value = 0, 0, np.zeros(1)
    while True:
        offset = find_word(text, offset)
        if offset == len(text):
            return row
        if offset != NOT_HERE:
            offset = parse_number(text, offset, value)
        if offset == NOT_HERE:
            return NOT_HERE
        rows[row, 0] = value[0]
        column, first = 1, 0
        for bone in range(len(counts)):
            offset = find_word(text, offset)
            if offset != NOT_HERE:
                offset = skip_name(text, offset, names[first : ends[bone]])
            first = ends[bone]
            for _ in range(counts[bone]):
                # After a mismatch, skip the rest of the bone.
                if offset != NOT_HERE:
                    offset = find_word(text, offset)
                if offset != NOT_HERE:
                    offset = parse_number(text, offset, value)
                rows[row, column] = value[0]
                column += 1
            if offset == NOT_HERE:
                return NOT_HERE
        row += 1
