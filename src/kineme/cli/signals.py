"""Options for recordings without a skeleton, and how such files are read and told."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from kineme.recordings.signals import Signals

PANEL = "Signals without a skeleton"

Columns = Annotated[
    str | None,
    typer.Option(
        metavar="NAME,NAME,…",
        help="Take these columns or analog channels as signals, in place of joints.",
        rich_help_panel=PANEL,
    ),
]
Emg = Annotated[
    bool,
    typer.Option(
        "--emg",
        help="Muscle signals: take their envelopes; of a C3D, muscles only.",
        rich_help_panel=PANEL,
    ),
]


@dataclass(frozen=True)
class SignalOptions:
    """What the user said of signals; a file is one if something was said, or by its content."""

    columns: tuple[str, ...] | None
    emg: bool
    fps: float | None

    @classmethod
    def of(cls, columns: str | None, fps: float | None, *, emg: bool = False) -> SignalOptions:
        """The options as they were typed."""
        names = None
        if columns is not None:
            names = tuple(name.strip() for name in columns.split(",") if name.strip())
            if not names:
                raise typer.BadParameter("names no column", param_hint="--columns")
        return cls(names, emg, fps)

    def mean(self, path: Path) -> bool:
        """Whether a file is to be read as signals."""
        from kineme.formats.channels.reading import is_signal_file

        return self.columns is not None or self.emg or is_signal_file(path)

    def read(self, path: Path) -> Signals:
        """The signals in a file."""
        from kineme.formats.channels.reading import read_signals

        return read_signals(path, columns=self.columns, fps=self.fps, emg=self.emg)

    def drawn(self, signals: Signals) -> Signals:
        """The signals as a page compares their moments: muscles by their envelopes."""
        if not self.emg:
            return signals
        from kineme.features.emg import emg_envelope

        return replace(signals, values=emg_envelope(signals.values, signals.fps))


def signal_facts(signals: Signals) -> dict[str, Any]:
    """What ``kineme info`` tells of signals."""
    source = signals.provenance
    return {
        "path": source.path,
        "format": source.format,
        "sha256": source.sha256,
        "frames": signals.n_frames,
        "fps": signals.fps,
        "seconds": signals.duration,
        "channels": list(signals.names),
        "gaps": [list(gap) for gap in signals.gaps],
        "notes": list(source.notes),
    }


def show_signals(facts: dict[str, Any]) -> None:
    """Print the facts for people."""
    from kineme.cli.tables import show_facts

    lines = {
        "format": f"{facts['format']}, signals without a skeleton",
        "length": f"{facts['frames']} frames at {facts['fps']:g} Hz, {facts['seconds']:.2f} s",
        "channels": f"{len(facts['channels'])}: {', '.join(facts['channels'])}",
        "SHA-256": facts["sha256"],
    }
    show_facts(facts, lines)
