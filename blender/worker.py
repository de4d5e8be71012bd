"""What runs in kineme's Python: a task of the extension, with kineme's public names alone.

    python worker.py FOLDER

``task.json`` in the folder names the task and what it needs. Each line that is printed is a stage;
``answer.json`` is what came out, or a sentence on why nothing did.
"""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import kineme
from kineme.segments import editing


def segmented(task: dict[str, Any]) -> dict[str, Any]:
    """The table of a recording."""
    said("reading")
    recording = kineme.read(task["recording"])
    found = kineme.segment(recording, effectors=joints(task["effectors"]), progress=said)
    found = found.at_detail(task["detail"])
    provenance = dict(found.provenance)
    provenance["input"] = {"path": task["name"], "format": "Blender", "sha256": None}
    return {"table": as_json(replace(found, provenance=provenance), task)}


def searched(task: dict[str, Any]) -> dict[str, Any]:
    """Spans of a recording that are like one of it: start, stop and distance, the nearest first."""
    folder = Path(task["recording"]).parent / "library"
    said("making it searchable")
    kineme.library.build(task["recording"], folder)
    said("searching")
    example = kineme.library.Example(task["recording"], task["start_s"], task["stop_s"])
    hits = kineme.Library(folder).search(example)
    return {"hits": [[hit.start_s, hit.stop_s, hit.distance] for hit in hits]}


def named(task: dict[str, Any]) -> dict[str, Any]:
    """The table with names for clusters and for single segments."""
    found = from_json(task)
    for cluster, name in task["clusters"].items():
        found = editing.name_cluster(found, int(cluster), name)
    for frame, name in task["segments"].items():
        found = editing.name_segment(found, task["level"], int(frame), name)
    return {"table": as_json(found, task)}


def saved(task: dict[str, Any]) -> dict[str, Any]:
    """Nothing; the table is a file, of the format that its suffix names."""
    kineme.write_segments(from_json(task), task["path"])
    return {}


TASKS = {"segment": segmented, "search": searched, "name": named, "save": saved}


def as_json(found: kineme.Segmentation, task: dict[str, Any]) -> Any:
    """A table as JSON has it."""
    path = Path(task["folder"]) / "table.json"
    kineme.write_segments(found, path)
    return json.loads(path.read_text(encoding="utf-8"))


def from_json(task: dict[str, Any]) -> kineme.Segmentation:
    """The table of a task."""
    path = Path(task["folder"]) / "given.json"
    path.write_text(json.dumps(task["table"]), encoding="utf-8")
    return kineme.read_segments(path)


def joints(text: str) -> dict[str, str] | list[str] | None:
    """Head, hands and feet as named by the user: all five, or some by their parts."""
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not any("=" in word for word in words):
        return words or None
    return {part.strip(): name.strip() for part, _, name in (word.partition("=") for word in words)}


def said(stage: str) -> None:
    """Print a stage for Blender to show."""
    sys.stdout.write(f"{stage}\n")
    sys.stdout.flush()


def main(folder: Path) -> None:
    """Do the task in a folder, and leave its answer there."""
    task = json.loads((folder / "task.json").read_text(encoding="utf-8")) | {"folder": str(folder)}
    try:
        answer = TASKS[task["task"]](task)
    except (kineme.KinemeError, OSError) as error:
        answer = {"failure": str(error)}
    (folder / "answer.json").write_text(json.dumps(answer), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
