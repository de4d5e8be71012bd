"""What is asked of each recording of a command: how to read it and how to segment it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from kineme.cli.options.reading import effector_names
from kineme.errors import ParameterError
from kineme.methods.presets import DEFAULT, resolve_preset
from kineme.segments.hierarchy import check_detail

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.methods.base import Found
    from kineme.recordings import Motion, Signals
    from kineme.segments.segmentation import Segmentation

Stage = Callable[[str], None]


@dataclass(frozen=True)
class Request:
    """The options of a command, checked.

    Parameters
    ----------
    preset : str
        Name of the preset.
    constants : dict of str to object
        Those of the preset that were given.
    reading : dict of str to object
        Keywords of `kineme.read` that were given.
    effectors : joints, optional
        For head, hands and feet.
    detail : float
        Of the result: 1 as found, less is coarser, more is finer.
    """

    preset: str
    constants: dict[str, Any]
    reading: dict[str, Any]
    effectors: Names | None
    detail: float = 1.0

    @classmethod
    def of(
        cls,
        preset: str = DEFAULT,
        constants: dict[str, Any] | None = None,
        reading: dict[str, Any] | None = None,
        effectors: str | None = None,
        detail: float = 1.0,
    ) -> Request:
        """The options as they were typed; typer.BadParameter where one makes no sense."""
        try:
            resolve_preset(preset, **(constants or {}))
            check_detail(detail)
        except ParameterError as error:
            raise typer.BadParameter(str(error)) from error
        named = effector_names(effectors)
        return cls(preset, constants or {}, reading or {}, named, detail)

    @property
    def emg(self) -> bool:
        """Whether channels are those of muscles."""
        return bool(self.reading.get("emg"))

    def read(self, path: Path) -> Motion | Signals:
        """The recording in a file, of the kind that it is or was said to be."""
        from kineme.formats import read

        return read(path, **self.reading)

    def read_motion(self, path: Path) -> Motion:
        """The motion in a file; ReadError for signals, which have no body to compare."""
        from kineme.formats import read_motion

        return read_motion(path, **self.reading)

    def segment(self, recording: Motion | Signals, stage: Stage) -> tuple[Segmentation, Found]:
        """The segments at the detail asked for, and what was found on the way to them."""
        from kineme.segmentation.segmenter import segment_and_found

        result, found = segment_and_found(
            recording,
            preset=self.preset,
            effectors=self.effectors,
            emg=self.emg,
            progress=stage,
            **self.constants,
        )
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

        if not (self.emg and isinstance(recording, Signals)):
            return recording
        from kineme.features.emg import emg_envelope

        return replace(recording, values=emg_envelope(recording.values, recording.fps))
