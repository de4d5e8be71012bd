"""Compiled parser of AMC text, for frames that all have the same layout."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

TENS = 10.0 ** np.arange(23)  # powers of ten that are exact as float64

EXACT = 1 << 53  # integers up to this are exact as float64
TAB, NEWLINE, RETURN, SPACE = 9, 10, 13, 32
PLUS, MINUS, POINT, ZERO, NINE = 43, 45, 46, 48, 57
NOT_HERE = -1  # returned if the text differs, and if the given offset is this one
BYTES = "Array(uint8, 1, 'C', readonly=True)"


@njit(f"int64({BYTES}, int64)", **OPTIONS)
def find_next_word(text, offset):
    """Return the start of the next word of a line; a space or tab must precede it."""
    before = offset
    while 0 <= offset < len(text) and text[offset] in (SPACE, TAB):
        offset += 1
    return offset if offset > before else NOT_HERE


@njit(f"int64({BYTES}, int64)", **OPTIONS)
def find_next_line(text, offset):
    """Return the start of the first word after this line, which must have no other words."""
    has_ended = False
    while 0 <= offset < len(text) and text[offset] in (SPACE, TAB, RETURN, NEWLINE):
        has_ended |= text[offset] == NEWLINE
        offset += 1
    return offset if has_ended else NOT_HERE


@njit(f"int64({BYTES}, int64, {BYTES})", **OPTIONS)
def skip_name(text, offset, name):
    """Return the end of a name that starts here."""
    if offset < 0 or offset + len(name) > len(text):
        return NOT_HERE
    for i in range(len(name)):
        if text[offset + i] != name[i]:
            return NOT_HERE
    return offset + len(name)


@njit(f"int64({BYTES}, int64, int64)", **OPTIONS)
def skip_label(text, offset, label):
    """Return the end of the whole number that starts here, if it is this one."""
    start, number = offset, 0
    while 0 <= offset < len(text) and ZERO <= text[offset] <= NINE and number <= label:
        number = 10 * number + (text[offset] - ZERO)
        offset += 1
    return offset if offset > start and number == label else NOT_HERE


@njit(f"int64({BYTES}, int64, float64[::1])", **OPTIONS)
def parse_number(text, offset, value):
    """Return the end of a number that starts here, and store its value.

    Return `NOT_HERE` if there is none, or if dividing an integer by a power of ten may round
    differently from ``float``.
    """
    if offset < 0:
        return NOT_HERE
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


@njit(
    f"UniTuple(int64, 2)({BYTES}, int64, int64, {BYTES}, int64[::1], int64[::1], float64[:, ::1])",
    **OPTIONS,
)
def read_rows(text, start, label, names, ends, counts, rows):
    """Parse the values of frames into rows, and return their number and the offset of the rest.

    A frame is a line with its number, then a line for each bone with its name (``names`` up to its
    end) and its values. ``start`` is the end of the line before the first frame, ``label`` the
    number before its own. The last frame is left to the rest, as more lines may follow it.
    """
    offset, last, value = start, start, np.zeros(1)
    for row in range(len(rows)):
        begin = offset
        offset = skip_label(text, find_next_line(text, offset), label + 1 + row)
        column, first = 0, 0
        for bone in range(len(counts)):
            offset = skip_name(text, find_next_line(text, offset), names[first : ends[bone]])
            first = ends[bone]
            for _ in range(counts[bone]):
                offset = parse_number(text, find_next_word(text, offset), value)
                rows[row, column] = value[0]
                column += 1
        if offset == NOT_HERE:
            return max(row - 1, 0), last
        last = begin
    return len(rows) - 1, last
