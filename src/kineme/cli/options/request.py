"""What is asked of each recording of a command: how to read it and how to segment it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from kineme.cli.options.method import constants_of
from kineme.cli.options.reading import effector_names
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT
from kineme.segmentation.options import SegmentOptions
from kineme.segments.hierarchy import DEFAULT_DETAIL, check_detail

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.methods.base import Found
    from kineme.recordings import Motion, Signals
    from kineme.segments.segmentation import Segmentation

Stage = Callable[[str], None]
EVERYBODY = "all"


def of_everybody(reading: dict[str, Any]) -> tuple[bool, dict[str, Any]]:
    """Whether all the people in a file are asked for, and how it is read otherwise."""
    if reading.get("person") != EVERYBODY:
        return False, reading
    return True, {name: value for name, value in reading.items() if name != "person"}


@dataclass(frozen=True)
class Request:
    """The options of a command, checked: how recordings are read and segmented, in what detail."""

    options: SegmentOptions
    reading: dict[str, Any]
    detail: float = DEFAULT_DETAIL

    @classmethod
    def of(
        cls,
        preset: str = DEFAULT,
        constants: Sequence[str] | None = None,
        reading: dict[str, Any] | None = None,
        effectors: str | None = None,
        detail: float = DEFAULT_DETAIL,
    ) -> Request:
        """The options as they were typed; typer.BadParameter where one makes no sense."""
        try:
            check_detail(detail)
        except ParameterError as error:
            raise typer.BadParameter(str(error), param_hint="--detail") from error
        options = SegmentOptions(
            preset=preset,
            constants=constants_of([preset], constants or ()),
            effectors=effector_names(effectors),
            emg=bool((reading or {}).get("emg")),
        )
        return cls(options, reading or {}, detail)

    @property
    def effectors(self) -> Names | None:
        """Joints for head, hands and feet, where they were named."""
        return self.options.effectors

    @property
    def person(self) -> str:
        """Who was named of several people."""
        return str(self.reading.get("person", ""))

    def read(self, path: Path) -> Motion | Signals:
        """The recording in a file, of the kind that it is or was said to be."""
        from kineme.formats import read

        return read(path, **self.reading)

    def of_each_person(self, path: Path) -> list[tuple[str, Request]]:
        """The people in a file where all are asked for, and what is asked of each of them.

        A single one, or the one who was named, goes without a name.
        """
        everybody, others = of_everybody(self.reading)
        if not everybody:
            return [("", self)]
        from kineme.formats import ReadOptions, people_in

        people = people_in(path, ReadOptions(**others))
        if not people:
            return [("", replace(self, reading=others))]
        return [(who, replace(self, reading={**others, "person": who})) for who in people]

    def read_motion(self, path: Path) -> Motion:
        """The motion in a file; ReadError for signals, which have no body to compare."""
        from kineme.formats import read_motion

        return read_motion(path, **self.reading)

    def segment(self, recording: Motion | Signals, stage: Stage) -> tuple[Segmentation, Found]:
        """The segments at the detail asked for, and what was found on the way to them."""
        from kineme.segmentation.segmenter import segmented

        result, found = segmented(recording, self.options, progress=stage)
        return result.level(self.detail), found

    def segments(
        self, recording: Motion | Signals, table: Path | None, stage: Stage
    ) -> Segmentation:
        """The segments in a table or label file; without one those that are found."""
        if table is None:
            return self.segment(recording, stage)[0]
        from kineme.labels.collections import labels_for

        return labels_for(
            Path(recording.provenance.path or ""),
            table,
            n_frames=recording.n_frames,
            fps=recording.fps,
            clock=recording.provenance.clock,
        )

    def drawn(self, recording: Motion | Signals) -> Motion | Signals:
        """The recording as a page compares its frames: muscles by their envelopes."""
        from kineme.recordings import Signals

        if not (self.options.emg and isinstance(recording, Signals)):
            return recording
        from kineme.features.emg import emg_envelope

        return replace(recording, values=emg_envelope(recording.values, recording.fps))
