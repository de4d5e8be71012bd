"""What the page offers: presets with the constants that matter most, and formats.

All of it comes from the registered objects: a preset says which of its
constants a page offers to change and within which limits, a format what it is
for and how it is downloaded.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from msgspec import UNSET

from kineme.errors import ParameterError
from kineme.labels import label_formats
from kineme.methods import PRESETS, Constant, resolve_preset
from kineme.methods.constants import Slider
from kineme.methods.levels import DETAILS
from kineme.methods.presets import DEFAULT
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.web.messages import ExportFormat, Parameter, PresetChoice
from kineme.web.requests import SegmentAgain

CLIPS, REPORT = "motions", "report"
"""What can be downloaded besides the formats of :mod:`kineme.labels`: motion files, a page."""


UNITS = {"body sizes": "body heights"}
"""What a page calls units that need knowledge of the package; a body's size is about its height."""


def list_presets() -> list[PresetChoice]:
    """Return the presets, the default first."""
    return [
        PresetChoice(
            name=name,
            help=preset.help,
            parameters=_list_parameters(name, signals=False),
            signal_parameters=_list_parameters(name, signals=True),
        )
        for name, preset in PRESETS.items()
    ]


def list_details() -> list[float]:
    """Return the levels of detail that a segmentation can have, the coarsest first."""
    return sorted({*DETAILS, DEFAULT_DETAIL})


def check_parameters(preset: str, parameters: Mapping[str, float], *, signals: bool) -> None:
    """ParameterError for constants that a page is not offered, or not with such values.

    Lengths are in the unit that they have for such a recording.
    """
    resolve_preset(preset)
    offered = {each.name: each for each in _list_parameters(preset, signals=signals)}
    for name, value in parameters.items():
        if name not in offered:
            raise ParameterError(f"{preset} offers {', '.join(offered)}, not {name!r:.40}")
        low, high = offered[name].minimum, offered[name].maximum
        if not low - 1e-9 <= value <= high + 1e-9:
            raise ParameterError(f"{name} can be {low:.4g} to {high:.4g}, not {value:.4g}")


def make_repeat_request(table: Segmentation, *, signals: bool) -> SegmentAgain:
    """To segment as a table was: by its preset, with what is offered of its constants.

    By the default preset where it does not say by which; nothing of the table is kept.
    """
    provenance = table.provenance
    preset, detail = str(provenance.get("preset")), provenance.get("detail")
    values = provenance.get("parameters") if preset in PRESETS else None
    preset = preset if preset in PRESETS else DEFAULT
    given = values if isinstance(values, Mapping) else {}
    parameters = {
        each.name: float(given[each.name])
        for each in _list_parameters(preset, signals=signals)
        if isinstance(given.get(each.name), int | float)
        and each.minimum <= given[each.name] <= each.maximum
    }
    return SegmentAgain(
        preset=preset,
        parameters=parameters,
        keep=False,
        detail=detail if isinstance(detail, float) else UNSET,
    )


def list_export_formats() -> list[ExportFormat]:
    """Return every format that segments can be downloaded in."""
    return [
        *(
            ExportFormat(name=each.name, suffix=each.download_suffix, help=each.help)
            for each in label_formats().values()
            if each.write
        ),
        ExportFormat(name=CLIPS, suffix=".zip", help="A motion file per segment"),
        ExportFormat(
            name=REPORT, suffix=".html", help="A page that shows it all, without a server"
        ),
    ]


def _list_parameters(preset: str, *, signals: bool) -> list[Parameter]:
    chosen, other = resolve_preset(preset), resolve_preset(preset, signals=signals)
    constants = other.constants()
    if type(chosen) is type(other):
        constants = tuple(map(_adapt_to_signals, chosen.constants(), constants))
    return [
        _make_parameter(each, each.slider)
        for each in constants
        if each.slider is not None and each.value is not None
    ]


def _make_parameter(declared: Constant, slider: Slider) -> Parameter:
    """Return a constant with a slider that can stand at the preset's own value."""
    below = math.floor((declared.value - slider.minimum) / slider.step + 1e-6)
    return Parameter(
        name=declared.name,
        help=declared.help,
        value=declared.value,
        minimum=declared.value - below * slider.step,
        maximum=slider.maximum,
        step=slider.step,
        unit=UNITS.get(declared.unit, declared.unit),
    )


def _adapt_to_signals(of_body: Constant, of_signals: Constant) -> Constant:
    """A constant as signals have it: the slider of a length reaches as far to either side."""
    slider = of_body.slider
    if (
        slider is None
        or not of_body.value
        or not of_signals.value
        or of_body.unit not in ("metres", "body sizes")
    ):
        return of_signals
    scale = of_signals.value / of_body.value
    unit = "standard deviations" if of_body.unit == "metres" else ""  # found in the recording
    slider = Slider(*(scale * bound for bound in slider))
    return replace(of_signals, slider=slider, unit=unit)
