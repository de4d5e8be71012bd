"""What the studio is told of its folder, and of what it offers; see `kineme.web.messages`."""

from __future__ import annotations

from msgspec import Struct


class Parameter(Struct, frozen=True, kw_only=True):
    """A constant of a preset that the page offers to change."""

    name: str
    help: str
    value: float
    minimum: float
    maximum: float
    step: float
    unit: str


class PresetChoice(Struct, frozen=True, kw_only=True):
    """A preset, and those of its constants that the page offers to change.

    ``signal_parameters`` are the same for signals, where lengths are in
    standard deviations of the channels.
    """

    name: str
    help: str
    parameters: list[Parameter]
    signal_parameters: list[Parameter]


class Listing(Struct, frozen=True, kw_only=True):
    """A recording of the folder, opened or not.

    ``segments``, ``checked`` and ``named`` count the rows of its table, if it has been saved
    (``corrected``), that are there, checked, have a name, and are no transitions.
    """

    id: str
    name: str
    bytes: int
    corrected: bool
    segments: int
    checked: int
    named: int
    to_name: int


class FileChoice(Struct, frozen=True, kw_only=True):
    """A file of the folder that an operation can use: a knowledge base, a label file."""

    id: str
    name: str


class ExportFormat(Struct, frozen=True, kw_only=True):
    """A format that segments can be written in, and the suffix of what is downloaded."""

    name: str
    suffix: str
    help: str


class State(Struct, frozen=True, kw_only=True):
    """What the studio offers: the first message a page asks for.

    ``suffixes`` are those of files that can be recordings, ``details`` the levels of detail that
    a segmentation may have, ``labels`` those that all recordings share, ``of_library`` whether the
    recordings are those of a library.
    """

    version: str
    folder: str
    of_library: bool
    suffixes: list[str]
    recordings: list[Listing]
    presets: list[PresetChoice]
    default_preset: str
    details: list[float]
    labels: list[str]
    knowledge_bases: list[FileChoice]
    annotations: list[FileChoice]
    export_formats: list[ExportFormat]
