"""What the page offers: presets with the constants that matter most, and formats."""

from __future__ import annotations

from collections.abc import Mapping

from kineme.errors import ParameterError
from kineme.labels import FORMATS
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS, resolve_preset
from kineme.web.messages import ExportFormat, Parameter, PresetChoice

CLIPS, REPORT = "motions", "report"
"""What can be taken away besides the formats of :mod:`kineme.labels`: motion files, a page."""
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
"""Of what is taken away, where the format has none of its own or it is several files."""


def presets() -> list[PresetChoice]:
    """The presets, the default first."""
    return [
        {"name": name, "help": preset.help, "parameters": _parameters(preset)}
        for name, preset in PRESETS.items()
    ]


def preset_of(name: str, parameters: Mapping[str, float]) -> Preset:
    """The preset with the given constants, each within its limits.

    Raises
    ------
    ParameterError : no such preset, a constant that is not offered, or one outside its limits
    """
    preset = resolve_preset(name)
    sliders = {known.name: known.slider for known in preset.constants() if known.slider}
    for constant, value in parameters.items():
        if constant not in sliders:
            raise ParameterError(f"{name} offers {', '.join(sliders)}, not {constant!r:.40}")
        low, high, _ = sliders[constant]
        if not low - 1e-9 <= value <= high + 1e-9:
            raise ParameterError(f"{constant} can be {low:.4g} to {high:.4g}, not {value:.4g}")
    return preset.replace(**parameters)


def export_formats() -> list[ExportFormat]:
    """Every format that segments can be taken away in."""
    formats: list[ExportFormat] = [
        {"name": name, "suffix": SUFFIXES.get(name) or FORMATS[name].suffixes[0], "help": text}
        for name, text in FORMAT_HELP.items()
    ]
    return [
        *formats,
        {"name": CLIPS, "suffix": ".zip", "help": "A motion file per segment"},
        {"name": REPORT, "suffix": ".html", "help": "A page that shows it all, without a server"},
    ]


def _parameters(preset: Preset) -> list[Parameter]:
    return [
        {
            "name": known.name,
            "help": known.help,
            "value": known.value,
            "minimum": known.slider.minimum,
            "maximum": known.slider.maximum,
            "step": known.slider.step,
            "unit": known.unit,
        }
        for known in preset.constants()
        if known.slider is not None
    ]
