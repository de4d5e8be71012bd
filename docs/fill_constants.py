"""The tables of constants in ``parameters.md``, from the presets themselves.

    python docs/fill_constants.py

Between the comments ``<!-- constants: METHOD -->`` and ``<!-- /constants -->``
stands a table of every constant of the method's presets.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import kineme
from kineme.methods import Preset

PAGE = Path(__file__).resolve().parent / "parameters.md"
MARK = re.compile(r"(<!-- constants: (\w+) -->\n).*?(<!-- /constants -->)", re.DOTALL)


def filled(text: str) -> str:
    """The page with every table as the presets have it; KeyError for a method not there."""
    methods: dict[str, list[Preset]] = {}
    for preset in kineme.PRESETS.values():
        methods.setdefault(preset.method, []).append(preset)
    return MARK.sub(lambda mark: f"{mark[1]}\n{table(methods[mark[2]])}\n\n{mark[3]}", text)


def table(presets: list[Preset]) -> str:
    """A row for each constant that any of these presets has."""
    of_each = [{known.name: known for known in preset.constants()} for preset in presets]
    rows = [
        ["constant", *(f"`{preset.name}`" for preset in presets), "unit", "may be", "meaning"],
        ["---"] * (len(presets) + 4),
    ]
    for name in dict.fromkeys(name for known in of_each for name in known):
        cells = [shown(known[name].value) if name in known else "" for known in of_each]
        told = next(known[name] for known in of_each if name in known)
        rows.append([f"`{name}`", *cells, told.unit, told.allowed, told.help])
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def shown(value: Any) -> str:
    """A constant's value, short."""
    match value:
        case None | bool():
            return {None: "–", True: "yes", False: "no"}[value]
        case float():
            return f"{value:.4g}"
        case ((_, _), *_):
            return " ".join(map(str, value))
        case tuple():
            return ", ".join(map(shown, value))
    return str(value)


def main() -> None:
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(filled(text), encoding="utf-8")


if __name__ == "__main__":
    main()
