"""Recognise tables of labels, which share suffixes with recordings, by their first bytes."""

from __future__ import annotations

import re

from kineme._util.files import HEAD
from kineme.formats.files import FileContent

_ELAN_HEADER = re.compile(r"(?:begin|end) time - (?:hh:mm:ss\.ms|ss\.msec|msec|\S+)", re.IGNORECASE)
_CLOCK_TIME = r"\d+:\d\d:\d\d\.\d{1,3}"
_SECONDS = r"\d+(?:\.\d+)?"
_ELAN_ROW = re.compile(
    # tier, participant (may be empty), begin, end, duration (optional), text
    rf"(?!{_SECONDS}\t)[^\t]+\t[^\t]*(?:\t(?:{_CLOCK_TIME}|{_SECONDS})){{2,}}\t[^\t]*[^\d\s][^\t]*"
)


def is_elan_table(head: str) -> bool:
    """Return whether a text starts like a tab-delimited export of ELAN, with or without names."""
    lines = [line.strip("\r") for line in head.splitlines() if line.strip()]
    lines = [line for line in lines if not line.startswith('"#')]
    if not lines:
        return False
    return len(_ELAN_HEADER.findall(lines[0])) >= 2 or all(map(_ELAN_ROW.fullmatch, lines[:2]))


def is_boris_table(head: str) -> bool:
    """Return whether a text starts like an export of events from BORIS."""
    cells = {cell.strip('"') for cell in re.split(r"[,\t\r\n]", head)}
    return "Behavior" in cells and ("Time" in cells or {"Start (s)", "Stop (s)"} <= cells)


def find_label_program(head: str) -> str | None:
    """Return the program whose table of labels starts with this text, or None."""
    return "ELAN" if is_elan_table(head) else "BORIS" if is_boris_table(head) else None


def refuse_labels(content: FileContent) -> None:
    """Raise ReadError if a text file holds labels."""
    if program := find_label_program(content.text[:HEAD]):
        raise content.error(
            f"holds labels of {program}, not a recording: read it with "
            "kineme.read_segments, or use kineme convert with --fps"
        )
