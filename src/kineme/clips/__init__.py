"""Recordings cut into clips: a file per segment, loops that close, a manifest."""

from typing import Literal

RootMotionMode = Literal["keep", "extract", "in-place"]
"""What becomes of the root motion of clips: see `kineme.clips.root_motion`."""

TargetName = Literal["unreal", "unity", "blender", "godot"]
"""Programs that clips are made for: see `kineme.clips.options.TARGETS`."""
