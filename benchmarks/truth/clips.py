"""Check that clips fit the rig of their recording and have the right tags.

    python -m benchmarks clips [--record]

Uses the characters, the Mixamo dance and the clips of `rigs`, and Blender, three.js and the glTF
validator if installed: ``KINEME_BPY`` names a Python that has the package ``bpy`` (5.0),
``KINEME_NODE`` a folder ``node_modules`` with ``three`` and ``gltf-validator``.
`python -m benchmarks loops` checks loops.

Promises: rest poses are equal and joints are read back within 0.01 mm; in Blender and three.js they
are within 0.1 mm; mirrored clips keep their skeleton; a bone that stays still changes no tag and no
rank; meshes and skins are copied byte for byte; 95 % of walks have the direction of their name.
"""

from __future__ import annotations

import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import judge, run_kineme
from _options import choose_size, find_data, make_parser
from blender_reader import BPY, FRAMES, Pose, read_in_blender
from kineme.clips.root_motion import measure_travel
from kineme.clips.shaping import find_planted_feet, measure_loops
from kineme.recordings.posing import add_root, get_rig

SOURCES = (("samba.fbx", None), ("Xbot.glb", "walk"), ("RobotExpressive.glb", "Walking"),
           ("bandai_namco/dataset-1_dash_normal_001.bvh", None))  # fmt: skip
WALKS = {"walk": "forwards", "walk-back": "backwards", "walk-left": "left", "walk-right": "right"}
FEWEST = 95.0
MM = 1000.0
NODE = shutil.which("node") or ""
MODULES = Path(os.environ.get("KINEME_NODE", "node_modules"))
THREE, VALIDATOR = MODULES / "three", MODULES / "gltf-validator"
HAS_THREE, HAS_VALIDATOR = (bool(NODE) and module.exists() for module in (THREE, VALIDATOR))
IN_THREE = """
(async () => {
  const [folder, path, name, frames] = process.argv.slice(1);
  globalThis.self = globalThis;
  const three = await import(folder + "/build/three.module.js");
  const { GLTFLoader } = await import(folder + "/examples/jsm/loaders/GLTFLoader.js");
  const bytes = new Uint8Array(require("fs").readFileSync(path)).buffer;
  const file = await new GLTFLoader().parseAsync(bytes, "");
  const mixer = new three.AnimationMixer(file.scene);
  mixer.clipAction(file.animations.find((clip) => clip.name === name)).play();
  const poses = JSON.parse(frames).map((frame) => {
    mixer.setTime(frame / 30);
    file.scene.updateMatrixWorld(true);
    const pose = {};
    file.scene.traverse((each) => {
      if (each.isBone) pose[each.name] = new three.Vector3().setFromMatrixPosition(
        each.matrixWorld).toArray();
    });
    return pose;
  });
  console.log(JSON.stringify(poses));
})();
"""
VALIDATE = """
const [folder, ...paths] = process.argv.slice(1);
const { validateBytes } = require(folder);
(async () => {
  let errors = 0;
  for (const path of paths) {
    const report = await validateBytes(new Uint8Array(require("fs").readFileSync(path)));
    errors += report.issues.numErrors;
  }
  console.log(errors);
})();
"""


def main() -> int:
    parser = make_parser(__doc__)
    add_option(parser)
    parser.parse_args()
    rigs = find_data("rigs")
    with tempfile.TemporaryDirectory() as home:
        folder = Path(home)
        kept = [*check_round_trip(rigs, folder), *check_copies(rigs, folder)]
        kept += [*check_mirroring(rigs), *check_root_bone(), *check_tags(rigs)]
        measure_cost(rigs, folder)
    for program, is_installed in (
        ("Blender (KINEME_BPY)", BPY),
        ("three.js (KINEME_NODE)", HAS_THREE),
        ("gltf-validator (KINEME_NODE)", HAS_VALIDATOR),
    ):
        if not is_installed:
            print(f"not asked, not installed: {program}")
    return int(not all(kept))


def check_limit(name: str, value: float, most: float, what: str, unit: str = "mm") -> bool:
    """Print and record a number; return whether it is within its limit."""
    print(f"{what}: {value:.3g} {unit}, {judge(value, most)}")
    record(f"clips.{name}", float(f"{value:.2g}"), unit=unit)
    return value <= most


def check_round_trip(rigs: Path, folder: Path) -> Iterator[bool]:
    """Write FBX, GLB and BVH and read them back, here and in Blender."""
    rest = joints = posed = seen = height = 0.0
    for name, take in choose_size(SOURCES, SOURCES[-1:]):
        source = rigs / name
        motion = kineme.read(source, take=take)
        path = folder / f"same{source.suffix}"
        kineme.write(motion, path)
        back = kineme.read(
            path, unit=get_rig(motion.skeleton).unit if path.suffix == ".bvh" else None
        )
        shared = [(back.joint(each), j) for j, each in enumerate(motion.skeleton.names)]
        here, there = (np.array(each) for each in zip(*shared, strict=True))
        off = back.positions[: motion.n_frames, here] - motion.positions[:, there]
        joints = max(joints, float(np.abs(off).max()))
        one, other = (
            get_rig(back.skeleton).rest()[0][here],
            get_rig(motion.skeleton).rest()[0][there],
        )
        rest = max(rest, float(np.abs(one - other).max()))
        if not BPY:
            continue
        expected = read_in_blender(source, folder, take or "")
        suffixes = [source.suffix, *([".glb"] if source.suffix == ".fbx" else [])]
        for suffix in suffixes:
            kineme.write(motion, folder / f"seen{suffix}")
            found = read_in_blender(folder / f"seen{suffix}", folder)
            seen = max(seen, measure_distance(expected[:1], found[:1]))
            posed = max(posed, measure_distance(expected[1:], found[1:]))
            if source.suffix == ".fbx":
                height = max(
                    height, abs(measure_hip_height(expected[0]) - measure_hip_height(found[0]))
                )
    yield check_limit("rest", MM * rest, 0.01, "rest pose read back, at worst")
    yield check_limit("joints", MM * joints, 0.01, "joints read back, at worst")
    if BPY:
        yield check_limit("blender", MM * posed, 0.1, "posed joints in Blender, at worst")
        yield check_limit("blender.rest", MM * seen, 0.1, "rest pose in Blender, at worst")
        yield check_limit(
            "height", MM * height, 1.0, "hips above feet of the Mixamo dance in Blender"
        )


def measure_distance(expected: list[Any], found: list[Any]) -> float:
    """Return the largest distance of bones of the same name, in metres."""
    shared = expected[0].keys() & found[0].keys()
    pairs = zip(expected, found, strict=True)
    return max(
        float(np.abs(np.subtract(a[bone], b[bone])).max()) for a, b in pairs for bone in shared
    )


def measure_hip_height(rest: dict[str, list[float]]) -> float:
    """Return the height of the hips above the lower foot; z is up in Blender."""
    heights = {name.rpartition(":")[2]: place[2] for name, place in rest.items()}
    return heights["Hips"] - min(heights["LeftFoot"], heights["RightFoot"])


def check_copies(rigs: Path, folder: Path) -> Iterator[bool]:
    """Check copies of characters: data that differs, and bones in three.js."""
    differing, written, off = 0, list[Path](), 0.0
    for name, take in (("Xbot.glb", "walk"), ("RobotExpressive.glb", "Walking")):
        source, path = rigs / name, folder / name
        run_kineme("split", source, "--take", take, "-o", path, "-q")
        written.append(path)
        (tree, data), (before, old) = read_glb(path), read_glb(source)
        differing += sum(
            tree.get(part) != before.get(part) for part in ("materials", "skins", "nodes")
        )
        for number in sorted(list_accessors(before)):
            differing += read_accessor(tree, data, number) != read_accessor(before, old, number)
        if HAS_THREE:
            clip = tree["animations"][0]["name"]
            poses = zip(read_in_three(source, take), read_in_three(path, clip), strict=True)
            off = max(off, *(measure_distance([a], [b]) for a, b in poses))
    yield check_limit(
        "copied", differing, 0, "parts of mesh, skin, materials that differ in the copy", ""
    )
    if HAS_THREE:
        yield check_limit("three", MM * off, 0.1, "joints of a character's clip in three.js")
    if HAS_VALIDATOR:
        sources = [rigs / path.name for path in written]
        added = count_errors(written) - count_errors(sources)
        yield check_limit(
            "errors", added, 0, "errors of the glTF validator that the source has not", ""
        )


def read_glb(path: Path) -> tuple[dict[str, Any], bytes]:
    data = path.read_bytes()
    (size,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def list_accessors(tree: dict[str, Any]) -> set[int]:
    """Return the accessors of meshes, blend shapes and skins."""
    found = {skin["inverseBindMatrices"] for skin in tree["skins"]}
    for mesh in tree["meshes"]:
        for part in mesh["primitives"]:
            tables = [part["attributes"], *part.get("targets", ())]
            found |= {n for table in tables for n in table.values()} | {part["indices"]}
    return found


def read_accessor(tree: dict[str, Any], data: bytes, accessor: int) -> bytes:
    view = tree["bufferViews"][tree["accessors"][accessor]["bufferView"]]
    start = view.get("byteOffset", 0)
    return data[start : start + view["byteLength"]]


def check_mirroring(rigs: Path) -> Iterator[bool]:
    """Check that mirroring keeps the skeleton."""
    differ, twice = 0, 0.0
    for name, take in SOURCES[:2] + SOURCES[3:]:
        motion = kineme.read(rigs / name, take=take)
        other = kineme.mirror(motion)
        off = np.abs(other.skeleton.offsets - motion.skeleton.offsets).max(axis=1)
        differ += int((off > 1e-9).sum())
        twice = max(twice, float(np.abs(kineme.mirror(other).positions - motion.positions).max()))
    yield check_limit("mirrored", differ, 0, "joints of the skeleton that mirroring changes", "")
    yield check_limit("mirrored.twice", MM * twice, 0.01, "mirrored twice, joints off")


def check_root_bone() -> Iterator[bool]:
    """Check that a root bone changes no tag and no rank."""
    motion = kineme.read(kineme.bundled_recording())
    rows, found = list(kineme.segment(motion).primitives), []
    for each in (motion, add_root(motion)):
        costs = [
            quality.cost for quality in measure_loops(each, rows, find_planted_feet(each)).values()
        ]
        travel = measure_travel(each)
        tags = [travel.tags(row.start_frame, row.stop_frame) for row in rows] if travel else []
        found.append((np.argsort(costs).tolist(), tags))
    yield check_limit(
        "rooted", int(found[0] != found[1]), 0, "tags and ranks changed by a root bone", ""
    )


def check_tags(rigs: Path) -> Iterator[bool]:
    """Check the direction of walks, their activities and steps against the file name."""
    right = list[bool]()
    for path in choose_size(sorted((rigs / "bandai_namco").glob("*_walk*.bvh")), []):
        direction = WALKS.get(path.stem.split("_")[1])
        if direction is None:
            continue
        motion = kineme.read(path)
        travel, table = measure_travel(motion), kineme.segment(motion).table
        spans = [(0, motion.n_frames)]
        spans += [(r.start_frame, r.stop_frame) for r in table if r.kind != "transition"]
        right += [travel is not None and direction in travel.tags(*span) for span in spans]
    if right:
        share = 100 * float(np.mean(right))
        said = "kept" if share >= FEWEST else "NOT KEPT"
        print(f"direction of {len(right)} clips of walks tagged rightly: {share:.1f} %")
        print(f"at least {FEWEST:g} % promised: {said}")
        record("clips.tagged", round(share, 1), unit="%")
        yield share >= FEWEST


def measure_cost(rigs: Path, folder: Path) -> None:
    """Measure the time to build a library of the clips and write the best loops."""
    home, library = rigs / "bandai_namco", folder / "library"
    recordings = choose_size(list(home.glob("*.bvh")), [])
    commands = {
        "build": ("library", "build", home, "--into", library, "--jobs", 1, "-q"),
        "split": ("library", "split", library, "--best", 3, "-o", folder / "loops"),
    }
    for name, command in commands.items() if recordings else ():
        _, used_s, _ = run_kineme(*command)
        each = used_s / len(recordings)
        print(f"library {name}: {each:.2f} CPU s for each of {len(recordings)} recordings")
        record(f"clips.{name}", round(each, 2), unit="CPU s")


def read_in_three(path: Path, animation: str) -> list[Pose]:
    """Return the positions of bones in `FRAMES` of an animation, in metres."""
    found: list[Pose] = _run_node(IN_THREE, THREE, path, animation, json.dumps(FRAMES))
    return found


def count_errors(paths: Sequence[Path]) -> int:
    """Count the errors that the Khronos validator finds in glTF files."""
    return int(_run_node(VALIDATE, VALIDATOR, *paths))


def _run_node(program: str, module: Path, *arguments: object) -> Any:
    command = [NODE, "-e", program, str(module.resolve()), *map(str, arguments)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
