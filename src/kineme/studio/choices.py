"""What the page offers: presets with the constants that matter most, and formats."""

from __future__ import annotations

from collections.abc import Mapping
from math import sqrt
from typing import NamedTuple

from kineme.errors import ParameterError
from kineme.labels import FORMATS
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
"""What can be downloaded besides the formats of :mod:`kineme.labels`: motion files, a page."""
FORMAT_HELP = {
    "csv": "The table, for spreadsheets",
    "json": "Everything in one file",
    "parquet": "Everything, for pandas and others",
    "audacity": "Audacity label track, one level",
    "elan": "ELAN, both levels",
    "textgrid": "Praat, both levels",
    "bids": "BIDS events with their sidecar",
    "boris": "BORIS events",
    "babel": "BABEL, one level",
    "ms-tcn": "One label per frame, with the mapping",
    "clips": "Clip list for motion matching, one level",
}
SUFFIXES = {
    "textgrid": ".TextGrid",
    "boris": ".csv",
    "babel": ".json",
    "ms-tcn": ".zip",
    "clips": ".csv",
    "bids": ".zip",
}
"""Of what is downloaded, where the format has none of its own or it is several files."""


def presets() -> list[PresetChoice]:
    """The presets, the default first.

    Returns
    -------
    list of PresetChoice
    """
    return [
        PresetChoice(name=name, help=PRESET_HELP.get(name, ""), parameters=_parameters(preset))
        for name, preset in PRESETS.items()
    ]


def preset_of(name: str, parameters: Mapping[str, float]) -> Preset:
    """A preset with some of the constants that are offered changed.

    Parameters
    ----------
    name : str
        Of the preset.
    parameters : mapping of float
        The constants.

    Returns
    -------
    Preset

    Raises
    ------
    ParameterError
        No such preset, a constant that is not offered, or one outside its limits.
    """
    preset = resolve_preset(name)
    offered = {known.name: known for known in _parameters(preset)}
    for constant, value in parameters.items():
        if constant not in offered:
            raise ParameterError(f"{name} offers {', '.join(offered)}, not {constant!r:.40}")
        low, high = offered[constant].minimum, offered[constant].maximum
        if not low - 1e-9 <= value <= high + 1e-9:
            raise ParameterError(f"{constant} can be {low:.4g} to {high:.4g}, not {value:.4g}")
    return preset.replace(**parameters)


def export_formats() -> list[ExportFormat]:
    """Every format that segments can be downloaded in.

    Returns
    -------
    list of ExportFormat
    """
    return [
        *(
            ExportFormat(name=name, suffix=download_suffix(name), help=FORMAT_HELP.get(name, name))
            for name, known in FORMATS.items()
            if known.writes
        ),
        ExportFormat(name=CLIPS, suffix=".zip", help="A motion file per segment"),
        ExportFormat(
            name=REPORT, suffix=".html", help="A page that shows it all, without a server"
        ),
    ]


def download_suffix(name: str) -> str:
    """The suffix of what is downloaded in a format."""
    return SUFFIXES.get(name) or FORMATS[name].suffixes[0]


def _parameters(preset: Preset) -> list[Parameter]:
    says = constant_help()
    return [
        Parameter(
            name=known.name,
            help=says.get(known.name, ""),
            value=getattr(preset, known.name),
            minimum=known.minimum,
            maximum=known.maximum,
            step=known.step,
            unit=known.unit,
        )
        for known in RANGES.get(preset.name, ())
    ]
