"""The Blender extension: built, installed, and each of its buttons, to the frame.

    python -m benchmarks blender_extension --bpy PYTHON [--bpy PYTHON] [--record]

PYTHON is one that has Blender as a package (``pip install bpy``, 4.2 or later; it wants another
numpy, so that each gets an environment of its own), or several are named by ``KINEME_BPY``. The
extension is built and validated by Blender's own program, installed from the zip, and reads the
bundled recording as BVH and as a GLB that kineme wrote. kineme runs as a process.

Promises, in each version: the table is that of ``kineme.segment`` for the same file, row by row;
markers, strips, clips, jumps, preview and names are where the table says, to the frame; clips pose
the armature as the action does; undo and redo, save and open lose nothing; what is missing is said;
work goes on by ticks of a timer as at once, and leaves no process where it is cancelled; panels
show what Blender knows. Joints are within 0.01 mm of kineme's own reading.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few, skip
from kineme.recordings.kinematics import forward_kinematics

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "benchmarks" / "_blender_extension.py"
TOOL = """
import bpy
print(bpy.utils.system_resource("SCRIPTS") + "/addons_core/bl_pkg/cli/blender_ext.py")
"""
FRAMES = few(None, 1000)
FIRST = 11
"""Where the BVH is put in the scene, so that no frame of the table is one of the scene."""
MOST_MM = 0.01
SAID = (
    *("there is no program", "what is searched for?", "no preview range", "no joint is called"),
    " repetitions",  # of work that ticks of a timer take on
)


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--bpy", action="append", metavar="PYTHON")
    add_option(parser)
    named = parser.parse_args().bpy or os.environ.get("KINEME_BPY", "").split(os.pathsep)
    pythons = [python for python in named if python]
    if not pythons:
        skip("needs a Python that has bpy: name it with --bpy, or in KINEME_BPY")
    failed = False
    for python in pythons:
        with tempfile.TemporaryDirectory() as folder:
            failed |= tried(python, Path(folder))
    return int(failed)


def tried(python: str, place: Path) -> bool:
    """Whether anything is wrong with one version."""
    recordings = samples(place)
    held = in_blender(python, place, recordings)
    version = "_".join(map(str, held["version"][:2]))
    wrong, segments = [], 0
    for sample, shown in zip(recordings, held["recordings"], strict=True):
        expected = kineme.segment(kineme.read(sample["path"]))
        found = [f"{Path(sample['path']).name}: {what}" for what in faults(expected, sample, shown)]
        wrong += found
        segments += len(expected)
    said, end = held["refused"][:-1], held["refused"][-1]
    for text, sentence in zip(said, SAID, strict=True):
        wrong += [] if sentence in text else [f"{text!r} in place of {sentence!r}"]
    wrong += [] if end == "ended" else ["what was cancelled went on"]
    away = joints_away(recordings[0])
    kept = f"faults {verdict(len(wrong), 0)}: {len(wrong)}; mm {verdict(away, MOST_MM)}: {away:.5f}"
    print(f"Blender {'.'.join(map(str, held['version']))}: {segments} segments compared; {kept}")
    for fault in wrong:
        print(f"  {fault}")
    record(f"blender_extension.{version}.segments", segments)
    record(f"blender_extension.{version}.faults", len(wrong))
    record(f"blender_extension.{version}.mm", round(away, 5), unit="mm")
    return bool(wrong) or away > MOST_MM


def samples(place: Path) -> list[dict[str, Any]]:
    """The bundled recording, as BVH and as GLB."""
    motion = kineme.read(kineme.bundled_recording())[:FRAMES]
    paths = [place / "exercises.bvh", place / "exercises.glb"]
    for path in paths:
        kineme.write(motion, path)
    return [
        {"path": str(path), "first": first, "fps": motion.fps, "frames": motion.n_frames,
         "output": str(place / path.suffix[1:] / "shown")}
        for path, first in zip(paths, (FIRST, 0), strict=True)
    ]  # fmt: skip


def in_blender(python: str, place: Path, recordings: list[dict[str, Any]]) -> dict[str, Any]:
    """What the extension did in one Blender, once it was built, validated and installed there."""
    task = {
        "home": str(place / "home"),
        "zip": str(place / "kineme.zip"),
        "python": str(python_of_kineme(place)),
        "output": str(place / "held.json"),
        "recordings": recordings,
    }
    for recording in recordings:
        Path(recording["output"]).parent.mkdir()
    (place / "task.json").write_text(json.dumps(task), encoding="utf-8")
    tool = run(python, "-c", TOOL).splitlines()[-1]
    source = str(ROOT / "blender")
    run(python, tool, "build", "--source-dir", source, "--output-filepath", task["zip"])
    run(python, tool, "validate", task["zip"])
    run(python, str(PROGRAM), str(place / "task.json"))
    return json.loads(Path(task["output"]).read_text(encoding="utf-8"))


def python_of_kineme(place: Path) -> Path:
    """A Python that has kineme and what it finds now; Blender's own is to find nothing of it."""
    program = place / "python3"
    path = os.environ.get("PYTHONPATH", "")
    program.write_text(f'#!/bin/sh\nPYTHONPATH="{path}" exec "{sys.executable}" "$@"\n')
    program.chmod(0o755)
    return program


def run(*command: str) -> str:
    """What a command of Blender prints; it ends the script where that fails."""
    bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=bare)
    if done.returncode:
        sys.exit(done.stdout[-2000:] + done.stderr[-2000:])
    return done.stdout


def faults(
    expected: kineme.Segmentation, sample: dict[str, Any], shown: dict[str, Any]
) -> list[str]:
    """What of a recording is not as kineme's own table of it says."""
    first, named = shown["first"], dict(enumerate(("stroll",)))
    checks = {
        "first frame": first == sample["first"],
        "table": cells(shown["table"]) == cells_of(expected),
        "jumps": shown["jumps"] == (first + expected.cuts()).tolist(),
        "undo": shown["undone"],
        "redo": shown["redone"],
        "save and open": shown["opened"],
        "similar": len(shown["similar"]) > 0,
        "panels": all(text in shown["panels"][0] for text in ("1 × cluster 1", "kineme.save"))
        and "kineme.cancel" in shown["panels"][1],
    }
    start = first + expected.activities[-2].start_frame  # one back from where the last starts
    checks["preview"] = shown["preview"] == [start, first + expected.cuts()[-1] - 1]
    for level in ("activity", "primitive"):
        checks |= {f"{what} of {level}": fine for what, fine in
                   levels(expected, first, level, shown[level]).items()}  # fmt: skip
    names = {row["label"] for row in shown["named"]["segments"] if row["cluster"] in named}
    others = {row["label"] for row in shown["named"]["segments"] if row["cluster"] not in named}
    checks["names"] = names == {"stroll"} and others == {""}
    for suffix in (".json", ".csv"):
        saved = kineme.read_segments(f"{sample['output']}{suffix}")
        checks[f"saved {suffix}"] = (
            cells_of(saved) == cells_of(expected) and saved.activities[0].label == "stroll"
        )
    clips = [clip for level in ("activity", "primitive") for clip in shown[level]["clips"].values()]
    lines = [line.split(":") for line in shown["catalogues"].splitlines()]
    catalogues = {line[0]: line[1] for line in lines if len(line) == 3}
    checks["catalogues"] = all(catalogues[which] == f"kineme/{name}" for *_, which, name in clips)
    return [what for what, fine in checks.items() if not fine]


def levels(
    expected: kineme.Segmentation, first: int, level: Any, shown: dict[str, Any]
) -> dict[str, bool]:
    """Whether markers, strips and clips of a level are where the table says."""
    rows = list(expected.level(level))
    clips = [row for row in rows if row.kind != "transition"]
    spans = [[first + row.start_frame, first + row.stop_frame - 1] for row in clips]
    strips = sorted(strip[1:] for track in shown["strips"].values() for strip in track)
    return {
        "markers": [frame for frame, name in shown["markers"] if name != "mine"]
        == [first + row.start_frame for row in rows],
        "own marker": [5, "mine"] in shown["markers"],
        "tracks": sorted(map(len, shown["strips"].values()))
        == sorted(
            [row.cluster for row in clips].count(each) for each in {r.cluster for r in clips}
        ),
        "strips": strips == [[start, stop, start] for start, stop in spans],
        "clips": sorted(clip[:2] for clip in shown["clips"].values())
        == sorted([1, row.stop_frame - row.start_frame] for row in clips),
        "poses of clips": shown["differ"] < 1e-4,
    }


def cells(table: dict[str, Any]) -> list[tuple[Any, ...]]:
    """Of a table as JSON, what must be equal."""
    columns = ("level", "kind", "start_frame", "stop_frame", "cluster")
    return [tuple(row[column] for column in columns) for row in table["segments"]]


def cells_of(found: kineme.Segmentation) -> list[tuple[Any, ...]]:
    """The same of a segmentation."""
    return [(row.level, row.kind, row.start_frame, row.stop_frame, row.cluster) for row in found]


def joints_away(sample: dict[str, Any]) -> float:
    """Millimetres by which joints are elsewhere than kineme reads them, or rotations lead them."""
    plain, turned = (kineme.read(f"{sample['output']}.{form}.npz") for form in ("plain", "turned"))
    motion = kineme.read(sample["path"])
    joints = [motion.joint(name) for name in plain.skeleton.names]
    worst = float(np.abs(plain.positions - motion.positions[:, joints]).max())
    for each in (plain, turned):
        led = forward_kinematics(each.skeleton, each.rotations, each.positions[:, 0])
        worst = max(worst, float(np.abs(led - each.positions).max()))
    return 1000 * worst


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
