"""What is asked of each recording of a command: how to read it and how to segment it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from kineme.cli.reading import effector_names
from kineme.cli.signals import SignalOptions
from kineme.errors import ParameterError, ReadError
from kineme.methods.base import Preset
from kineme.methods.presets import DEFAULT, resolve_preset

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.methods.base import Found
    from kineme.recordings.motion import Motion
    from kineme.recordings.signals import Signals
    from kineme.segments.segmentation import Segmentation

Stage = Callable[[str], None]


@dataclass(frozen=True)
class Request:
    """The options of a command, checked; see `of`."""

    preset: Preset
    overrides: dict[str, Any]
    reading: dict[str, Any]
    signals: SignalOptions
    effectors: Names | None

    @classmethod
    def of(
        cls,
        preset: str = DEFAULT,
        overrides: dict[str, Any] | None = None,
        reading: dict[str, Any] | None = None,
        effectors: str | None = None,
        columns: str | None = None,
        *,
        emg: bool = False,
    ) -> Request:
        """The options as they were typed; typer.BadParameter where one makes no sense."""
        overrides, reading = overrides or {}, reading or {}
        try:
            chosen = resolve_preset(preset, **overrides)
        except ParameterError as error:
            raise typer.BadParameter(str(error)) from error
        signals = SignalOptions.of(columns, reading.get("fps"), emg=emg)
        return cls(chosen, overrides, reading, signals, effector_names(effectors))

    def read(self, path: Path) -> Motion | Signals:
        """The recording in a file, of the kind that it is or was said to be."""
        if self.signals.mean(path):
            return self.signals.read(path)
        from kineme.formats import read

        return read(path, **self.reading)

    def read_motion(self, path: Path) -> Motion:
        """The motion in a file; ReadError for signals, which have no body to compare."""
        from kineme.formats import read
        from kineme.formats.channels.reading import is_signal_file

        if is_signal_file(path):
            raise ReadError(path, "holds signals without a skeleton, where a motion is needed")
        return read(path, **self.reading)

    def segment(self, recording: Motion | Signals, stage: Stage) -> tuple[Segmentation, Found]:
        """The segments, and what was found on the way to them."""
        from kineme.segmentation.segmenter import segment_and_found

        return segment_and_found(
            recording,
            preset=self.preset.name,
            effectors=self.effectors,
            emg=self.signals.emg,
            progress=stage,
            **self.overrides,
        )

    def segments(
        self, recording: Motion | Signals, table: Path | None, stage: Stage
    ) -> Segmentation:
        """The segments in a table or label file; without one those that are found."""
        if table is None:
            return self.segment(recording, stage)[0]
        from kineme.labels import read_segments

        return read_segments(table, fps=recording.fps, n_frames=recording.n_frames)

    def drawn(self, recording: Motion | Signals) -> Motion | Signals:
        """The recording as a page compares its frames: muscles by their envelopes."""
        from kineme.recordings.motion import Motion

        return recording if isinstance(recording, Motion) else self.signals.drawn(recording)
