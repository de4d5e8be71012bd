"""A list for motion matching from the manifest of clips.

    python motion_matching.py loops/manifest.json motion_matching.json

Unreal's PoseSearch, O3DE's MotionMatching gem and the packages for Unity all want to be told which
sequences to search, in which range of them, and which go round. This writes that as JSON, with one
entry for each clip, and one for each recording with the ranges that were cut from it::

    {"schema": "kineme.motion_matching/1",
     "clips": [{"sequence": "take_0000_walk", "file": "take.glb", "range_s": [0, 1.1],
                "loop": true, "mirrored": false, "tags": ["walk", "forwards"],
                "feet": {"left": [[0, 0.2]]}}],
     "recordings": [{"source": "take.bvh", "take": null,
                     "ranges": [{"range_s": [2.7, 3.8], "tags": ["walk"]}]}]}

Seconds throughout; a range ends one frame after its last. Needs Python only.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any


def main() -> None:
    """Read one list, write the other."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("manifest", type=Path)
    parser.add_argument("output", type=Path)
    given = parser.parse_args()
    clips = json.loads(given.manifest.read_text(encoding="utf-8"))["clips"]
    text = json.dumps(motion_matching(clips), ensure_ascii=False, indent=1)
    given.output.write_text(f"{text}\n", encoding="utf-8")


def motion_matching(clips: list[dict[str, Any]]) -> dict[str, Any]:
    """The list of the clips of a manifest."""
    recordings: dict[tuple[str, str | None], list[dict[str, Any]]] = {}
    for clip in sorted(clips, key=lambda clip: clip["start_s"]):
        span = [clip["start_s"], clip["stop_s"]]
        source = clip["source"], clip["source_take"]
        recordings.setdefault(source, []).append({"range_s": span, "tags": tags(clip)})
    return {
        "schema": "kineme.motion_matching/1",
        "clips": [sequence(clip) for clip in clips],
        "recordings": [
            {"source": source, "take": take, "ranges": ranges}
            for (source, take), ranges in recordings.items()
        ],
    }


def sequence(clip: dict[str, Any]) -> dict[str, Any]:
    """What is to be known of one clip."""
    seconds = 1 / clip["fps"]
    feet = clip["planted"] or {}
    return {
        "sequence": clip["name"],
        "file": clip["file"],
        "range_s": [0.0, clip["round_s"] or round(clip["n_frames"] * seconds, 6)],
        "loop": clip["loop"],
        "mirrored": "mirror" in clip["changes"],
        "tags": tags(clip),
        "feet": {
            side: [[round(frame * seconds, 6) for frame in span] for span in spans]
            for side, spans in feet.items()
        },
    }


def tags(clip: dict[str, Any]) -> list[str]:
    """What a clip is called, its label or else its cluster, and where it goes."""
    if clip["kind"] == "transition":
        return ["transition", *clip["tags"]]
    return [clip["label"] or f"cluster {clip['cluster']}", *clip["tags"]]


if __name__ == "__main__":
    main()
