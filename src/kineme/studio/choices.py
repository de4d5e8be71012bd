"""What the page offers: presets with the constants that matter most, and formats."""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt
from typing import NamedTuple

from kineme.errors import ParameterError
from kineme.labels import label_formats
from kineme.methods.presets import PRESETS, Preset, constant_help, resolve_preset
from kineme.web.messages import ExportFormat, Parameter, PresetChoice


class Range(NamedTuple):
    """How a constant may be changed."""

    name: str
    minimum: float
    maximum: float
    step: float
    unit: str


# Those of "What to change when" in docs/parameters.md; limits within which results make sense.
RANGES = {
    "kineme": (
        Range("max_scale", 0.08, 0.4, 0.01, "body sizes"),
        Range("border_cost", 0.25, 6.0, 0.25, "s"),
        Range("likeness", 0.1, 1.0, 0.05, ""),
        Range("min_action", 0.2, 10.0, 0.1, "s"),
        Range("phase", 0.25, 5.0, 0.25, "s"),
    ),
    "voegele2014": (
        Range("radius", 0.2, 1.6, 0.02, "m"),
        Range("min_primitive", 0.05, 3.0, 0.05, "s"),
        Range("growth_gap", 1 / 30, 2.0, 1 / 30, "s"),
        Range("coverage", 0.1, 1.0, 0.05, ""),
    ),
    "krueger2017": (
        Range("radius", 0.05 * sqrt(5), 0.27 * sqrt(5), 0.005 * sqrt(5), "m"),
        Range("min_primitive", 0.05, 3.0, 0.05, "s"),
        Range("growth_gap", 1 / 30, 2.0, 1 / 30, "s"),
        Range("coverage", 0.1, 1.0, 0.02, ""),
    ),
}
PRESET_HELP = {
    "kineme": "Finds activities and counts their repetitions; for use.",
    "voegele2014": "As published in 2014; to compare with.",
    "krueger2017": "As published in 2017; to compare with.",
}
CLIPS, REPORT = "motions", "report"
"""What can be taken away besides the formats of :mod:`kineme.labels`: motion files, a page."""


def presets() -> list[PresetChoice]:
    """The presets, the default first."""
    return [
        {"name": name, "help": PRESET_HELP[name], "parameters": _parameters(preset)}
        for name, preset in PRESETS.items()
    ]


def preset_of(name: str, parameters: Mapping[str, float]) -> Preset:
    """The preset with the given constants, each within its limits.

    Raises
    ------
    ParameterError : no such preset, a constant that is not offered, or one outside its limits
    """
    preset = resolve_preset(name)
    ranges = {known.name: known for known in RANGES[name]}
    for constant, value in parameters.items():
        if constant not in ranges:
            raise ParameterError(f"{name} offers {', '.join(ranges)}, not {constant!r:.40}")
        low, high = ranges[constant].minimum, ranges[constant].maximum
        if not low - 1e-9 <= value <= high + 1e-9:
            raise ParameterError(f"{constant} can be {low:.4g} to {high:.4g}, not {value:.4g}")
    return preset.replace(**parameters)


def export_formats() -> list[ExportFormat]:
    """Every format that segments can be taken away in."""
    formats: list[ExportFormat] = [
        {"name": known.name, "suffix": known.download_suffix, "help": known.help}
        for known in label_formats().values()
        if known.write
    ]
    return [
        *formats,
        {"name": CLIPS, "suffix": ".zip", "help": "A motion file per segment"},
        {"name": REPORT, "suffix": ".html", "help": "A page that shows it all, without a server"},
    ]


def _parameters(preset: Preset) -> list[Parameter]:
    says = constant_help()
    return [
        {
            "name": known.name,
            "help": says.get(known.name, ""),
            "value": getattr(preset, known.name),
            "minimum": known.minimum,
            "maximum": known.maximum,
            "step": known.step,
            "unit": known.unit,
        }
        for known in RANGES[preset.name]
    ]
