"""Measured numbers in README and docs, filled in from ``figures.json``.

    python docs/fill_figures.py

The pages have plain numbers. Which figure each is, ``quoted.txt`` says: under the name of a page, a
line for each passage of it, with the name of the figure and its format in place of the number::

    docs/speed.md
      an hour of {growth.kineme.1_h.seconds .1f} s

A passage is a row of a table or some words of a sentence. It is found wherever its lines break, and
must be there as often as it is listed. Benchmarks measure the figures anew (``--record``, see
``benchmarks/_figures.py``); one that is still to be measured is null there, and a dash here.

What is not measured by a benchmark of ours says why, and is left as it is: a limit, a promise, what
a paper says, what was seen once while something was made::

      labelled ones in {35.3 s; stated: the 2014 paper}

A test finds speed and memory that stand in no passage.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
FIGURES = HERE / "figures.json"
QUOTED = HERE / "quoted.txt"
PLACE = re.compile(r"\{(?:(?P<text>[^{};]+); stated: [^{}]+|(?P<name>\S+) (?P<format>\S+))\}")
NUMBER = r"–|[+-]?\d+(?:[.,]\d+)*"
NUMBERS = rf"(?:{NUMBER})(?:(?:,|\s/|\sto|\sof)\s(?:{NUMBER}))*"
"""What a figure of several numbers may be, such as "0.2 to 0.3"."""


class Place(NamedTuple):
    """Where a number stands on a page; no name of a figure if it is stated."""

    start: int
    stop: int
    name: str
    format: str


def quoted(text: str) -> dict[str, list[str]]:
    """By page, its passages."""
    pages: dict[str, list[str]] = {}
    listed: list[str] = []
    for line in text.splitlines():
        if line.startswith("  "):
            listed.append(line.strip())
        elif line and not line.startswith("#"):
            listed = pages[line] = []
    return pages


def places(page: str, passages: Iterable[str]) -> Iterator[Place]:
    """The numbers of all passages; LookupError for a passage that is not there as often."""
    alike: dict[str, list[str]] = {}
    for passage in passages:
        alike.setdefault(_shape(passage), []).append(passage)
    for shape, listed in alike.items():
        found = list(re.finditer(shape, page))
        if len(found) != len(listed):
            raise LookupError(f"{len(found)} and not {len(listed)} times there: {listed[0]}")
        for match, passage in zip(found, listed, strict=True):
            for number, place in enumerate(PLACE.finditer(passage), 1):
                yield Place(*match.span(number), place["name"] or "", place["format"] or "")


def filled(page: str, passages: Iterable[str], figures: Mapping[str, Mapping[str, Any]]) -> str:
    """The page with every number as the figures have it; KeyError for a name not there."""
    changes = []
    for place in places(page, passages):
        if place.name:
            shown = _shown(figures[place.name], place.format)
            if page[place.start : place.stop].split() != shown.split():  # else its lines may break
                changes.append((place, shown))
    return _with(page, changes)


def unquoted(page: str, passages: Iterable[str]) -> str:
    """The page without the numbers that say where they come from."""
    return _with(page, [(place, "") for place in places(page, passages)])


def main() -> None:
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    for name, passages in quoted(QUOTED.read_text(encoding="utf-8")).items():
        before = (ROOT / name).read_text(encoding="utf-8")
        try:
            after = filled(before, passages, figures)
        except LookupError as error:
            raise SystemExit(f"{name}: {error}") from error
        if after != before:
            (ROOT / name).write_text(after, encoding="utf-8")
            print(f"{name}: filled")


def _shape(passage: str) -> str:
    """An expression for it with any numbers, a group for each, and any breaks of lines."""
    shape, at = "", 0
    for place in PLACE.finditer(passage):
        shape += _words(passage[at : place.start()])
        if place["text"]:
            shape += f"({_words(place['text'])})"
        else:
            shape += f"({NUMBERS if place['format'] == 's' else NUMBER})"
        at = place.end()
    shape += _words(passage[at:])
    if passage.startswith("|"):
        return rf"(?m:^){shape}(?m:$)"
    return rf"(?<![\w.,]){shape}(?!\w|[.,]\d)"


def _words(text: str) -> str:
    return r"\s+".join(re.escape(word) for word in re.split(r"\s+", text))


def _with(page: str, changes: Sequence[tuple[Place, str]]) -> str:
    for place, text in sorted(changes, reverse=True):
        page = page[: place.start] + text + page[place.stop :]
    return page


def _shown(figure: Mapping[str, Any], form: str) -> str:
    return "–" if figure["value"] is None else format(figure["value"], form)


if __name__ == "__main__":
    main()
