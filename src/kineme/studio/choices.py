"""What the page offers: presets with their main constants, and download formats.

Everything comes from the registries. A preset declares which of its constants a page may change and
within which limits. A format declares its purpose and its download suffix.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from msgspec import UNSET

from kineme.errors import ParameterError
from kineme.labels import label_formats
from kineme.methods import PRESETS, Constant, resolve_preset
from kineme.methods.base import Slider
from kineme.methods.presets import DEFAULT
from kineme.methods.segments import DETAILS
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.web.messages import ExportFormat, Parameter, PresetChoice
from kineme.web.requests import SegmentAgain

CLIPS, REPORT = "motions", "report"
"""Download kinds besides the formats of :mod:`kineme.labels`: motion files and the report page."""


UNIT_NAMES = {"body sizes": "body heights"}
"""Unit names on the page; a body size is about the height of the body."""


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
    """Return the levels of detail of a segmentation, the coarsest first."""
    return sorted({*DETAILS, DEFAULT_DETAIL})


def check_parameters(preset: str, parameters: Mapping[str, float], *, signals: bool) -> None:
    """Raise ParameterError for constants that the page does not offer, or for values out of range.

    Lengths are in the unit of the kind of recording.
    """
    resolve_preset(preset)
    offered = {constant.name: constant for constant in _list_parameters(preset, signals=signals)}
    for name, value in parameters.items():
        if name not in offered:
            raise ParameterError(
                f"the page offers no {name!r:.40} for {preset}; there are {', '.join(offered)}"
            )
        low, high = offered[name].minimum, offered[name].maximum
        if not low - 1e-9 <= value <= high + 1e-9:
            raise ParameterError(f"{name} can be {low:.4g} to {high:.4g}, not {value:.4g}")


def make_repeat_request(table: Segmentation, *, signals: bool) -> SegmentAgain:
    """Return the request that repeats a segmentation with its preset and the offered constants.

    The default preset is used if the table names none. Corrections of the table are not kept.
    """
    provenance = table.provenance
    preset, detail = str(provenance.get("preset")), provenance.get("detail")
    values = provenance.get("parameters") if preset in PRESETS else None
    preset = preset if preset in PRESETS else DEFAULT
    saved_values = values if isinstance(values, Mapping) else {}
    parameters = {
        parameter.name: float(saved_values[parameter.name])
        for parameter in _list_parameters(preset, signals=signals)
        if isinstance(saved_values.get(parameter.name), int | float)
        and parameter.minimum <= saved_values[parameter.name] <= parameter.maximum
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
            ExportFormat(
                name=label_format.name, suffix=label_format.download_suffix, help=label_format.help
            )
            for label_format in label_formats().values()
            if label_format.write
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
        _make_parameter(constant, constant.slider)
        for constant in constants
        if constant.slider is not None and constant.value is not None
    ]


def _make_parameter(constant: Constant, slider: Slider) -> Parameter:
    """Return a constant with slider limits such that the preset's value is one of its steps."""
    steps_below = math.floor((constant.value - slider.minimum) / slider.step + 1e-6)
    return Parameter(
        name=constant.name,
        help=constant.help,
        value=constant.value,
        minimum=constant.value - steps_below * slider.step,
        maximum=slider.maximum,
        step=slider.step,
        unit=UNIT_NAMES.get(constant.unit, constant.unit),
    )


def _adapt_to_signals(of_body: Constant, of_signals: Constant) -> Constant:
    """Return the constant for signals; the slider of a length is scaled to their unit."""
    slider = of_body.slider
    if (
        slider is None
        or not of_body.value
        or not of_signals.value
        or of_body.unit not in ("metres", "body sizes")
    ):
        return of_signals
    scale = of_signals.value / of_body.value
    unit = "standard deviations" if of_body.unit == "metres" else ""  # known once the file is read
    slider = Slider(*(scale * bound for bound in slider))
    return replace(of_signals, slider=slider, unit=unit)
