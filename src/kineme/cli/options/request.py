"""What is asked of each recording of a command: how to read it and how to segment it.

A command is given the options of one or both by `asks`, the same for all commands.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from kineme._util.parallel import announce_compilation
from kineme.cli.options.method import Constants, Detail, PresetName, constants_of
from kineme.cli.options.reading import Effectors, Emg, effector_names, keywords_of
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.hierarchy import DEFAULT_DETAIL, check_detail

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.recordings import Motion, Signals
    from kineme.segments.segmentation import Segmentation

Stage = Callable[[str], None]
EVERYBODY = "all"
SEGMENTING: dict[str, Any] = {
    "preset": PresetName,
    "detail": Detail,
    "constants": Constants,
    "effectors": Effectors,
}
"""How a command segments."""


def asks(options: Mapping[str, Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command these options besides its own; checked, they reach it as ``request``."""
    added = [
        inspect.Parameter(
            name,
            inspect.Parameter.KEYWORD_ONLY,
            default=False if option is Emg else None,
            annotation=option,
        )
        for name, option in options.items()
    ]

    def with_options(command: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(command, eval_str=True)
        parameters = [each for each in signature.parameters.values() if each.name != "request"]

        @wraps(command)
        def wrapped(**values: Any) -> None:
            given = {name: values.pop(name) for name in options}
            command(**values, request=Request.of(**given))

        wrapped.__signature__ = signature.replace(parameters=[*parameters, *added])  # type: ignore[attr-defined]
        wrapped.__annotations__ = {each.name: each.annotation for each in (*parameters, *added)}
        return wrapped

    return with_options


def split_everybody(reading: dict[str, Any]) -> tuple[bool, dict[str, Any]]:
    """Return whether all the people in a file are asked for, and how it is read otherwise."""
    if reading.get("person") != EVERYBODY:
        return False, reading
    return True, {name: value for name, value in reading.items() if name != "person"}


@dataclass(frozen=True)
class Request:
    """Options of a command, checked: how recordings are read and segmented, in what detail."""

    options: SegmentOptions
    reading: dict[str, Any]
    detail: float = DEFAULT_DETAIL
    is_default: bool = True
    """Whether nothing was said."""

    @classmethod
    def of(
        cls,
        *,
        preset: str | None = None,
        detail: float | None = None,
        constants: Sequence[str] | None = None,
        effectors: str | None = None,
        **reading: Any,
    ) -> Request:
        """Return the options as they were typed; typer.BadParameter where one makes no sense."""
        keywords = keywords_of(reading)
        is_default = not any((preset, detail, constants, effectors, keywords))
        chosen, detail = preset or DEFAULT, DEFAULT_DETAIL if detail is None else detail
        try:
            check_detail(detail)
        except ParameterError as error:
            raise typer.BadParameter(str(error), param_hint="--detail") from error
        options = SegmentOptions(
            preset=chosen,
            constants=constants_of([chosen], constants or ()),
            effectors=effector_names(effectors),
            emg=bool(keywords.get("emg")),
        )
        return cls(options, keywords, detail, is_default=is_default)

    @property
    def effectors(self) -> Names | None:
        """Joints for head, hands and feet, where they were named."""
        return self.options.effectors

    @property
    def person(self) -> str:
        """Who was named of several people."""
        return str(self.reading.get("person", ""))

    def read(self, path: Path) -> Motion | Signals:
        """Return the recording in a file, of the kind that it is or was said to be."""
        from kineme.formats import read

        return read(path, **self.reading)

    def of_each_person(self, path: Path) -> list[tuple[str, Request]]:
        """Return the people and takes in a file where all are asked for, and what is asked of each.

        A single one, or the one that was named, goes without a name.
        """
        if self.reading.get("take") == EVERYBODY:
            return self._of_each_take(path)
        everybody, others = split_everybody(self.reading)
        if not everybody:
            return [("", self)]
        from kineme.formats import ReadOptions, people_in

        people = people_in(path, ReadOptions(**others))
        if not people:
            return [("", replace(self, reading=others))]
        return [(who, replace(self, reading={**others, "person": who})) for who in people]

    def _of_each_take(self, path: Path) -> list[tuple[str, Request]]:
        """Return the same where all takes are asked for; names are those of take and person."""
        from kineme.formats import ReadOptions, takes_in

        _, others = split_everybody(self.reading)
        del others["take"]
        takes: Sequence[str | None] = takes_in(path, ReadOptions(**others)) or (None,)
        found = []
        for take in takes:
            reading = {name: value for name, value in self.reading.items() if name != "take"}
            asked = replace(self, reading=reading | ({} if take is None else {"take": take}))
            for who, each in asked.of_each_person(path):
                found.append(("_".join(filter(None, (take, who))), each))
        return found

    def read_motion(self, path: Path) -> Motion:
        """Return the motion in a file; ReadError for signals, which have no body to compare."""
        from kineme.formats import read_motion

        return read_motion(path, **self.reading)

    def segment(self, recording: Motion | Signals, stage: Stage) -> Segmentation:
        """Return the segments at the detail asked for."""
        from kineme.methods.segmenter import segment_with_options

        with announce_compilation(stage):
            result, _ = segment_with_options(recording, self.options, progress=stage)
        return result.at_detail(self.detail)

    def segments(
        self, recording: Motion | Signals, table: Path | None, stage: Stage
    ) -> Segmentation:
        """Return the segments in a table or label file; without one those that are found."""
        if table is None:
            return self.segment(recording, stage)
        from kineme.labels.collections import labels_for

        return labels_for(
            Path(recording.provenance.path or ""),
            table,
            n_frames=recording.n_frames,
            fps=recording.fps,
            clock=recording.provenance.clock,
        )

    def drawn(self, recording: Motion | Signals) -> Motion | Signals:
        """Return the recording as a page compares its frames: muscles by their envelopes."""
        from kineme.recordings import Signals

        if not (self.options.emg and isinstance(recording, Signals)):
            return recording
        from kineme.features.emg import emg_envelope

        return replace(recording, values=emg_envelope(recording.values, recording.fps))
