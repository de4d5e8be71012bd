"""Numbers of speed and memory in a page that nobody measures: typed, and soon untrue.

Lengths of time are also what a method is told ("borders within 0.25 s"), so seconds count where
the sentence is about what work takes; memory and "times as fast" count anywhere, and so does
every number in a column whose head is a unit of either. What ``docs/quoted.txt`` lists is measured
or says where it comes from: it is to be taken off before.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby

CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.DOTALL | re.MULTILINE)
NUMBER = r"(?<![\w.,/@-])\d[\d.,]*(?: to \d[\d.,]*)?"
MEMORY = re.compile(NUMBER + r"\s(?:kB|MB|GB|TB|ms|µs)\b")
TIMES = re.compile(NUMBER + r" times (?:as (?:fast|slow|long|much memory)|faster|slower)\b")
SECONDS = re.compile(NUMBER + r"\s(?:s|seconds|minutes)\b")
COST = re.compile(
    r"(?<!the )(?<!would )\btakes?\b(?! off| of| up)|\btook\b(?! up)|\bneeds\b|\bprocessors?\b"
    r"|\bin memory\b|\bby the clock\b|\bshared cores\b|\bon (?:one|two) cores?\b"
)
HEAD = re.compile(r"\b(?:seconds|milliseconds|MB|GB|memory|times (?:the split|as))\b")


def typed_figures(page: str) -> Iterator[str]:
    """Each such number with the words around it."""
    text = CODE.sub("", page)
    lines = text.splitlines()
    for is_table, group in groupby(lines, key=lambda line: line.startswith("|")):
        if is_table:
            yield from in_table([line.strip("| ").split("|") for line in group])
        else:
            for sentence in re.split(r"(?<=[.;:])\s|\n\n|\n(?=[-#])", "\n".join(group)):
                yield from in_words(" ".join(sentence.split()))


def in_words(sentence: str) -> Iterator[str]:
    kinds = [MEMORY, TIMES, *([SECONDS] if COST.search(sentence) else [])]
    for kind in kinds:
        yield from (f"{found[0]}: {sentence:.100}" for found in kind.finditer(sentence))


def in_table(rows: list[list[str]]) -> Iterator[str]:
    head, *others = rows
    for row in others:
        for title, cell in zip(head, row, strict=False):
            if HEAD.search(title):
                yield from (f"{title.strip()}: {found[0]}" for found in re.finditer(NUMBER, cell))
        yield from in_words(" | ".join(cell.strip() for cell in row))
