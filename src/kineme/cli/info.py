"""``kineme info``: what a file is, and what had to be inferred about it."""

from __future__ import annotations

from json import dumps
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kineme.cli.inputs import Batch, Files, Recursive
from kineme.cli.reading import Effectors, Json
from kineme.cli.request import Request
from kineme.cli.signals import Columns, show_signals, signal_facts
from kineme.errors import EndEffectorError

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.recordings.motion import Motion


def info(
    files: Files,
    joints: Annotated[bool, typer.Option("--joints", help="Show the tree of joints.")] = False,
    recursive: Recursive = False,
    json: Json = False,
    effectors: Effectors = None,
    columns: Columns = None,
    reading: dict[str, Any] | None = None,
) -> None:
    """Tell a recording's format, length, frame rate and skeleton or channels."""
    request = Request.of(reading=reading, effectors=effectors, columns=columns)
    batch = Batch(files, recursive=recursive)
    for path in batch.paths:
        with batch.caught(path):
            recording = request.read(path)
            from kineme.recordings.motion import Motion

            if isinstance(recording, Motion):
                facts = _facts(recording, request.effectors)
            else:
                facts = signal_facts(recording)
            if json:
                typer.echo(dumps(facts))
            elif isinstance(recording, Motion):
                _show(facts, recording, joints=joints)
            else:
                show_signals(facts)
    batch.exit()


def _facts(motion: Motion, names: Names | None) -> dict[str, Any]:
    from kineme.features import PARTS, end_effectors

    source, skeleton = motion.provenance, motion.skeleton
    notes = list(source.notes)
    try:
        found = end_effectors(motion, names=names)
        parts = {
            part: skeleton.names[joint] for part, joint in zip(PARTS, found.indices, strict=True)
        }
    except EndEffectorError as error:
        parts = None
        notes.append(f"{error}; until then segments come from the distances between points")
    return {
        "path": source.path,
        "format": source.format,
        "sha256": source.sha256,
        "frames": motion.n_frames,
        "fps": motion.fps,
        "seconds": motion.duration,
        "joints": [name for j, name in enumerate(skeleton.names) if j not in skeleton.end_sites],
        "end_sites": [skeleton.names[j] for j in sorted(skeleton.end_sites)],
        "end_effectors": parts,
        "notes": notes,
    }


def _show(facts: dict[str, Any], motion: Motion, *, joints: bool) -> None:
    from kineme.cli.tables import show_facts

    parts = facts["end_effectors"] or {}
    lines = {
        "format": facts["format"],
        "length": f"{facts['frames']} frames at {facts['fps']:g} Hz, {facts['seconds']:.2f} s",
        "joints": f"{len(facts['joints'])}, and {len(facts['end_sites'])} end sites",
        "end effectors": ", ".join(
            f"{part.replace('_', ' ')} {name}" for part, name in parts.items()
        )
        or "not found",
        "SHA-256": facts["sha256"],
    }
    show_facts(facts, lines, below=_tree(motion) if joints else None)


def _tree(motion: Motion) -> Any:
    from rich.text import Text
    from rich.tree import Tree

    skeleton = motion.skeleton
    trunk = Tree("", hide_root=True)
    branches = {-1: trunk}
    for joint, (name, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        style = "dim" if joint in skeleton.end_sites else ""
        branches[joint] = branches[parent].add(Text(name, style=style))
    return trunk
