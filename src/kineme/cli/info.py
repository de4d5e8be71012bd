"""``kineme info``: show what a file contains, and what was inferred about it."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import RenderableType
from rich.table import Table
from rich.text import Text
from rich.tree import Tree

from kineme._util.checks import format_count
from kineme.cli.files import Batch, FilesOfFormats, Recursive
from kineme.cli.help import OUTPUT, option
from kineme.cli.options import READING, Effectors, Json, add_options
from kineme.cli.tables import make_columns, make_table, show_facts
from kineme.errors import EndEffectorError
from kineme.features import PARTS, Names, end_effectors
from kineme.formats import read, read_analog
from kineme.formats.options import ReadOptions
from kineme.formats.points import BODY
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals

Facts = dict[str, Any]
CHANNELS_PER_LINE = 12
"""Channels printed on one line; more are listed below."""


@add_options({"effectors": Effectors} | READING)
def info(
    files: FilesOfFormats,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    joints: Annotated[bool, option(OUTPUT, "Show the tree of joints.", "--joints")] = False,
    channels: Annotated[
        bool,
        option(OUTPUT, "Show what kineme cycles can measure, and from which joints.", "--channels"),
    ] = False,
    recursive: Recursive = False,
    json: Json = False,
) -> None:
    """Show the format, length, frame rate and joints of files."""

    def show(path: Path, options: ReadOptions, _: None) -> None:
        recording = read(path, **vars(options))
        facts = _collect_facts(recording, segment_options.effectors)
        if channels:
            facts["measures"] = _list_measures(path, recording, options)
        if json:
            typer.echo(dumps(facts))
        else:
            _show(facts, recording, joints=joints)

    batch = Batch(files, recursive=recursive)
    for path in batch.paths:
        batch.run_each_person(path, read_options, show)
    batch.exit()


def _collect_facts(recording: Motion | Signals, effectors: Names | None) -> Facts:
    """Return facts about a recording by name: its file, then its body or channels."""
    source = recording.provenance
    facts: Facts = {
        "path": source.path,
        "format": source.format,
        "sha256": source.sha256,
        "frames": recording.n_frames,
        "fps": recording.fps,
        "seconds": recording.duration,
        "gaps": [list(gap) for gap in recording.gaps],
        "notes": list(map(str, source.notes)),
    }
    if isinstance(recording, Motion):
        return _add_body(facts, recording, effectors)
    return facts | {"channels": list(recording.names)}


def _list_measures(path: Path, recording: Motion | Signals, options: ReadOptions) -> list[Facts]:
    """Return the channels that can be measured; see `kineme.cycles.channels_of`."""
    from kineme.cycles.channels import channels_of

    analog = read_analog(path, options) if isinstance(recording, Motion) else None
    channels = channels_of(recording, ["*"], beside=[] if analog is None else [analog])
    names = ("name", "unit", "group", "source")
    return [{name: getattr(channel, name) for name in names} for channel in channels]


def _add_body(facts: Facts, motion: Motion, effectors: Names | None) -> Facts:
    """Add joints and end effectors to the facts, or a note that these are unknown."""
    skeleton = motion.skeleton
    notes, effector_names = facts["notes"], None
    try:
        effector_joints = end_effectors(motion, names=effectors)
        effector_names = {
            part: skeleton.names[joint]
            for part, joint in zip(PARTS, effector_joints.indices, strict=True)
        }
    except EndEffectorError as error:
        until = "without them, kineme segments by the distances between points"
        notes = [*notes, f"{error}; {until}"]
    return facts | {
        "joints": [name for j, name in enumerate(skeleton.names) if j not in skeleton.end_sites],
        "end_sites": [skeleton.names[j] for j in sorted(skeleton.end_sites)],
        "end_effectors": effector_names,
        "notes": notes,
    }


def _show(facts: Facts, recording: Motion | Signals, *, joints: bool) -> None:
    notes = [note for note in facts["notes"] if note not in recording.provenance.warnings]
    if not joints:  # the markers of each joint interest few users
        notes = [note for note in notes if not note.startswith(BODY)]
    length = (
        f"{format_count(facts['frames'], 'frame')} at {facts['fps']:g} Hz, {facts['seconds']:.2f} s"
    )
    if isinstance(recording, Motion):
        named = (facts["end_effectors"] or {}).items()
        effectors = ", ".join(f"{part.replace('_', ' ')} {name}" for part, name in named)
        lines = {
            "format": facts["format"],
            "length": length,
            "joints": f"{len(facts['joints'])}, "
            f"and {format_count(len(facts['end_sites']), 'end site')}",
            "end effectors": effectors or "not found",
        }
        details: RenderableType | None = _build_tree(recording) if joints else None
    else:
        names = facts["channels"]
        is_long = len(names) > CHANNELS_PER_LINE
        lines = {
            "format": f"{facts['format']}, signals without a skeleton",
            "length": length,
            "channels": f"{len(names)}, below" if is_long else f"{len(names)}: {', '.join(names)}",
        }
        details = make_columns(names) if is_long else None
    if "measures" in facts:
        details = _tabulate_measures(facts["measures"])
    show_facts(facts | {"notes": notes}, lines | {"SHA-256": facts["sha256"]}, below=details)


def _tabulate_measures(measures: list[Facts]) -> Table:
    table = make_table("channel", "unit", "group", "from")
    for column in table.columns:
        column.justify = "left"
    for measure in measures:
        table.add_row(*map(str, measure.values()))
    return table


def _build_tree(motion: Motion) -> Tree:
    skeleton = motion.skeleton
    tree = Tree("", hide_root=True)
    branches = {-1: tree}
    for joint, (name, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        style = "dim" if joint in skeleton.end_sites else ""
        branches[joint] = branches[parent].add(Text(name, style=style))
    return tree
