"""Clips of a folder into Unreal, with what its manifest says of them.

NOT RUN: written after the documentation of Unreal Engine 5.4's Python API, and tried on a stand-in
for it only. Tell us what it does where you are.

In the editor, with the plugin "Python Editor Script Plugin": ``File > Execute Python Script``, or

    import import_clips
    import_clips.main("C:/takes/loops", "/Game/Takes")

Each file of the manifest is imported (GLB by Interchange). The sequences get sync markers where
feet come down, root motion where they have some, and label, cluster and rank as metadata.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import unreal

TRACK = "feet"


def main(folder: str, destination: str) -> dict[str, Any]:
    """The sequences that were found again, by the name of their clip."""
    place = Path(folder)
    clips = json.loads((place / "manifest.json").read_text(encoding="utf-8"))["clips"]
    import_files(sorted({str(place / clip["file"]) for clip in clips}), destination)
    found = {}
    sequences = by_name(destination)
    for clip in clips:
        name = clip["take"] or Path(clip["file"]).stem
        sequence = next((each for key, each in sequences.items() if key.endswith(name)), None)
        if sequence is None:
            unreal.log_warning(f"no sequence of the name {name}")
            continue
        describe(sequence, clip)
        found[clip["name"]] = sequence
    unreal.log(f"{len(found)} of {len(clips)} clips are there")
    return found


def import_files(paths: Iterable[str], destination: str) -> None:
    """Import files without asking."""
    tasks = []
    for path in paths:
        task = unreal.AssetImportTask()
        task.filename = path
        task.destination_path = destination
        task.automated = True
        task.replace_existing = True
        task.save = True
        tasks.append(task)
    unreal.AssetToolsHelpers.get_asset_tools().import_asset_tasks(tasks)


def by_name(destination: str) -> dict[str, Any]:
    """Animation sequences below a folder of the project."""
    found = {}
    for path in unreal.EditorAssetLibrary.list_assets(destination, recursive=True):
        asset = unreal.EditorAssetLibrary.load_asset(path)
        if isinstance(asset, unreal.AnimSequence):
            found[asset.get_name()] = asset
    return found


def describe(sequence: Any, clip: dict[str, Any]) -> None:
    """Leave in a sequence what the manifest says of it."""
    library = unreal.AnimationLibrary
    library.set_root_motion_enabled(sequence, "in place" not in clip["changes"])
    library.add_animation_notify_track(sequence, TRACK)
    for side, spans in (clip["planted"] or {}).items():
        for start, _ in spans:
            seconds = start / clip["fps"]
            library.add_animation_sync_marker(sequence, f"{side}_foot_down", seconds, TRACK)
    for name in ("label", "cluster", "loop", "rank"):
        if clip[name] is not None:
            tag = f"kineme_{name}"
            unreal.EditorAssetLibrary.set_metadata_tag(sequence, tag, str(clip[name]))
    unreal.EditorAssetLibrary.save_loaded_asset(sequence)
