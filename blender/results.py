"""What was found, in Blender: kept with the action, and shown as markers, strips and actions.

The record of `table` lies as JSON in a property of the action, or of an armature without one. So it
is saved with the file, copied with the action, and undone with what was done to it.
"""

import json
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import bpy

from . import curves
from .process import FailureError
from .table import (
    Marker,
    Record,
    catalogue_of,
    clips_of,
    frames_of,
    markers_of,
    name_of,
    same_markers,
    with_catalogues,
)

RECORD, HITS = "kineme_record", "kineme_hits"
"""Properties of what was segmented."""
CLIP_OF, CLIP_FROM, CATALOGUE = "kineme_clip_of", "kineme_clip_from", "kineme_catalogue"
"""Properties of actions that were cut from it: its name, their first frame in it, their cluster."""
TRACK = "kineme: "
CATALOGUES_FILE = "blender_assets.cats.txt"


def owner_of(armature: bpy.types.Object) -> bpy.types.ID:
    """What keeps the record of an armature: its action, else itself."""
    animation = armature.animation_data
    return animation.action if animation and animation.action else armature


def record_of(armature: bpy.types.Object | None) -> Record | None:
    """What was found in the action of an armature; None where nothing was."""
    record = None if armature is None else _kept(owner_of(armature), RECORD)
    return None if record is None else dict(record)


def keep_table(scene: bpy.types.Scene, owner: bpy.types.ID, record: Record, level: str) -> None:
    """Keep a record, and set a marker for each segment of a level in place of former ones."""
    former = (_kept(owner, RECORD) or {}).get("markers", [])
    record |= {"level": level, "markers": markers_of(record, level)}
    _set_markers(scene, former, record["markers"])
    owner[RECORD] = json.dumps(record)


def keep_hits(scene: bpy.types.Scene, owner: bpy.types.ID, hits: Sequence[Marker]) -> None:
    """Set markers for what a search found, in place of those of the one before."""
    _set_markers(scene, _kept(owner, HITS) or [], hits)
    owner[HITS] = json.dumps(hits)


def scene_markers(scene: bpy.types.Scene) -> list[Marker]:
    """The markers that there are."""
    return [Marker(marker.frame, marker.name) for marker in scene.timeline_markers]


def make_strips(armature: bpy.types.Object, record: Record, level: str) -> int:
    """Show segments as strips of the action, one track a cluster, and tell how many strips.

    Tracks made before go.
    """
    animation = _animation_of(armature)
    for track in [each for each in animation.nla_tracks if each.name.startswith(TRACK)]:
        animation.nla_tracks.remove(track)
    tracks: dict[Any, bpy.types.NlaTrack] = {}
    clips = clips_of(record, level)
    for name, row in clips:
        cluster = row["cluster"] if row["cluster"] >= 0 else name_of(row)
        if cluster not in tracks:
            tracks[cluster] = animation.nla_tracks.new()
            tracks[cluster].name = f"{TRACK}{name_of(row)}"
        first, last = frames_of(record, row)
        strip = tracks[cluster].strips.new(name, first, animation.action)
        curves.with_slot_of(strip, animation)
        strip.extrapolation = "NOTHING"
        strip.action_frame_start, strip.action_frame_end = first, last
    return len(clips)


def make_actions(armature: bpy.types.Object, record: Record, level: str) -> list[bpy.types.Action]:
    """An action for each segment, an asset in the catalogue of its cluster.

    Those made of this action before go, where nothing uses them.
    """
    action = _animation_of(armature).action
    for former in [each for each in bpy.data.actions if each.get(CLIP_OF) == action.name]:
        if former.users <= former.use_fake_user:
            bpy.data.actions.remove(former)
    clips = []
    for name, row in clips_of(record, level):
        first, last = frames_of(record, row)
        clip = curves.cut(action, name, first, last)
        for key in (RECORD, HITS):
            clip.pop(key, None)
        clip[CLIP_OF], clip[CLIP_FROM], clip[CATALOGUE] = action.name, first, name_of(row)
        clip.use_fake_user = True
        clip.asset_mark()
        clip.asset_data.catalog_id, _ = catalogue_of(name_of(row))
        clip.asset_data.tags.new(name_of(row), skip_if_exists=True)
        clips.append(clip)
    write_catalogues()
    return clips


def write_catalogues() -> None:
    """Name the catalogues of all clips in the file that asset browsers read.

    It lies beside the blend file, or at the top of the library that this is in; nowhere yet where
    the file was never saved. What it holds stays.
    """
    names = [action[CATALOGUE] for action in bpy.data.actions if CATALOGUE in action]
    if not bpy.data.filepath or not names:
        return
    folder = Path(bpy.data.filepath).parent
    for library in bpy.context.preferences.filepaths.asset_libraries:
        if library.path and folder.is_relative_to(Path(bpy.path.abspath(library.path))):
            folder = Path(bpy.path.abspath(library.path))
    path = folder / CATALOGUES_FILE
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    wanted = with_catalogues(text, names)
    if wanted != text:
        draft = path.with_suffix(".kineme")
        draft.write_text(wanted, encoding="utf-8")
        draft.replace(path)


def _animation_of(armature: bpy.types.Object) -> bpy.types.AnimData:
    """The animation data of an armature with an action; FailureError where there is none."""
    animation = armature.animation_data
    if animation is None or animation.action is None:
        raise FailureError(f"{armature.name} has no action: bake its motion into one first")
    if animation.use_tweak_mode:
        raise FailureError("leave the tweak mode of the NLA editor first")
    return animation


def _set_markers(
    scene: bpy.types.Scene, former: Iterable[Sequence[Any]], wanted: Iterable[Marker]
) -> None:
    """Take those markers away, and set these."""
    present = list(scene.timeline_markers)
    for _, place in same_markers(former, scene_markers(scene)):
        if place is not None:
            scene.timeline_markers.remove(present[place])
    for frame, name in wanted:
        scene.timeline_markers.new(name, frame=frame)


def _kept(owner: bpy.types.ID, key: str) -> Any:
    """What a property holds; None where there is none, or what kineme did not write."""
    text = owner.get(key)
    return _decoded(text) if isinstance(text, str) else None


@lru_cache(maxsize=4)  # panels ask with each redraw
def _decoded(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return None
