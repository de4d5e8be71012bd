"""Cut recordings into clips: one file per segment, seamless loops, and a manifest."""

from typing import Literal

RootMotionMode = Literal["keep", "extract", "in-place"]
"""How to treat the root motion of clips: see `kineme.clips.root_motion`."""

TargetName = Literal["unreal", "unity", "blender", "godot"]
"""Target programs of clips: see `kineme.clips.options.TARGETS`."""
