"""Clips: do they fit the rig that they came from, and are their tags right?

    python -m benchmarks clips [--record]

On the characters, the Mixamo dance and the clips of `rigs`. Blender, three.js and the glTF
validator are asked where they are (see `benchmarks/_viewers.py`); what is missing is said at the
end. Seams of loops are those of `python -m benchmarks loops`.

Promises: rest poses are equal and joints are read back within 0.01 mm; in Blender and three.js they
are within 0.1 mm; mirrored clips keep their skeleton; a bone that stays still changes no tag and no
rank; meshes and skins are copied byte for byte; 95 % of walks have the direction of their name.
"""

from __future__ import annotations

import json
import struct
import sys
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import kineme as run_kineme
from _measure import verdict
from _options import command_line, few, needed
from _viewers import count_errors, in_blender, in_three, missing
from kineme.clips.shaping import find_planted_feet, measure_loops
from kineme.clips.tags import measure_travel
from kineme.recordings.posing import add_root, get_rig

SOURCES = (("samba.fbx", None), ("Xbot.glb", "walk"), ("RobotExpressive.glb", "Walking"),
           ("bandai_namco/dataset-1_dash_normal_001.bvh", None))  # fmt: skip
WALKS = {"walk": "forwards", "walk-back": "backwards", "walk-left": "left", "walk-right": "right"}
FEWEST = 95.0
MM = 1000.0


def main() -> int:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    rigs, lacks = needed("rigs"), missing()
    with tempfile.TemporaryDirectory() as home:
        folder = Path(home)
        kept = [*same_out(rigs, folder, lacks), *copied(rigs, folder, lacks)]
        kept += [*mirrored(rigs), *rooted(), *tagged(rigs), *cost(rigs, folder)]
    for each in lacks:
        print(f"not asked, not installed: {each}")
    return int(not all(kept))


def told(name: str, value: float, most: float, what: str, unit: str = "mm") -> bool:
    """Say a number and whether it is small enough; keep it."""
    print(f"{what}: {value:.3g} {unit}, {verdict(value, most)}")
    record(f"clips.{name}", float(f"{value:.2g}"), unit=unit)
    return value <= most


def same_out(rigs: Path, folder: Path, lacks: list[str]) -> Iterator[bool]:
    """FBX, GLB, BVH and USD in, the same out."""
    rest = joints = posed = seen = height = 0.0
    for name, take in few(SOURCES, SOURCES[-1:]):
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
        if any("Blender" in each for each in lacks):
            continue
        expected = in_blender(source, folder, take or "")
        suffixes = [source.suffix, *([".glb"] if source.suffix == ".fbx" else [])]
        for suffix in suffixes:
            kineme.write(motion, folder / f"seen{suffix}")
            found = in_blender(folder / f"seen{suffix}", folder)
            seen = max(seen, apart(expected[:1], found[:1]))
            posed = max(posed, apart(expected[1:], found[1:]))
            if source.suffix == ".fbx":
                height = max(height, abs(rise(expected[0]) - rise(found[0])))
    yield told("rest", MM * rest, 0.01, "rest pose read back, at worst")
    yield told("joints", MM * joints, 0.01, "joints read back, at worst")
    if not any("Blender" in each for each in lacks):
        yield told("blender", MM * posed, 0.1, "posed joints in Blender, at worst")
        yield told("blender.rest", MM * seen, 0.1, "rest pose in Blender, at worst")
        yield told("height", MM * height, 1.0, "hips above feet of the Mixamo dance in Blender")


def apart(expected: list[Any], found: list[Any]) -> float:
    """Metres by which bones of the same name differ, at worst."""
    shared = expected[0].keys() & found[0].keys()
    pairs = zip(expected, found, strict=True)
    return max(
        float(np.abs(np.subtract(a[bone], b[bone])).max()) for a, b in pairs for bone in shared
    )


def rise(rest: dict[str, list[float]]) -> float:
    """How far the hips are above the lower foot; z is up in Blender."""
    heights = {name.rpartition(":")[2]: place[2] for name, place in rest.items()}
    return heights["Hips"] - min(heights["LeftFoot"], heights["RightFoot"])


def copied(rigs: Path, folder: Path, lacks: list[str]) -> Iterator[bool]:
    """Clips in a copy of each character: what differs, and where three.js puts the bones."""
    differing, written, off = 0, list[Path](), 0.0
    for name, take in (("Xbot.glb", "walk"), ("RobotExpressive.glb", "Walking")):
        source, path = rigs / name, folder / name
        run_kineme("split", source, "--take", take, "-o", path, "-q")
        written.append(path)
        (tree, data), (before, old) = glb(path), glb(source)
        differing += sum(
            tree.get(part) != before.get(part) for part in ("materials", "skins", "nodes")
        )
        for number in sorted(used(before)):
            differing += stored(tree, data, number) != stored(before, old, number)
        if not any("three" in each for each in lacks):
            clip = tree["animations"][0]["name"]
            poses = zip(in_three(source, take), in_three(path, clip), strict=True)
            off = max(off, *(apart([a], [b]) for a, b in poses))
    yield told("copied", differing, 0, "parts of mesh, skin, materials that differ in the copy", "")
    if not any("three" in each for each in lacks):
        yield told("three", MM * off, 0.1, "joints of a character's clip in three.js")
    if not any("validator" in each for each in lacks):
        sources = [rigs / path.name for path in written]
        added = count_errors(written) - count_errors(sources)
        yield told("errors", added, 0, "errors of the glTF validator that the source has not", "")


def glb(path: Path) -> tuple[dict[str, Any], bytes]:
    data = path.read_bytes()
    (size,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def used(tree: dict[str, Any]) -> set[int]:
    """Return the accessors of meshes, blend shapes and skins."""
    found = {skin["inverseBindMatrices"] for skin in tree["skins"]}
    for mesh in tree["meshes"]:
        for part in mesh["primitives"]:
            tables = [part["attributes"], *part.get("targets", ())]
            found |= {n for table in tables for n in table.values()} | {part["indices"]}
    return found


def stored(tree: dict[str, Any], data: bytes, accessor: int) -> bytes:
    view = tree["bufferViews"][tree["accessors"][accessor]["bufferView"]]
    start = view.get("byteOffset", 0)
    return data[start : start + view["byteLength"]]


def mirrored(rigs: Path) -> Iterator[bool]:
    """Joints of the skeleton that mirroring changes."""
    differ, twice = 0, 0.0
    for name, take in SOURCES[:2] + SOURCES[3:]:
        motion = kineme.read(rigs / name, take=take)
        other = kineme.mirror(motion)
        off = np.abs(other.skeleton.offsets - motion.skeleton.offsets).max(axis=1)
        differ += int((off > 1e-9).sum())
        twice = max(twice, float(np.abs(kineme.mirror(other).positions - motion.positions).max()))
    yield told("mirrored", differ, 0, "joints of the skeleton that mirroring changes", "")
    yield told("mirrored.twice", MM * twice, 0.01, "mirrored twice, joints off")


def rooted() -> Iterator[bool]:
    """Tags and ranks that a root bone changes."""
    motion = kineme.read(kineme.bundled_recording())
    rows, found = list(kineme.segment(motion).primitives), []
    for each in (motion, add_root(motion)):
        costs = [
            quality.cost for quality in measure_loops(each, rows, find_planted_feet(each)).values()
        ]
        travel = measure_travel(each)
        tags = [travel.tags(row.start_frame, row.stop_frame) for row in rows] if travel else []
        found.append((np.argsort(costs).tolist(), tags))
    yield told("rooted", int(found[0] != found[1]), 0, "tags and ranks changed by a root bone", "")


def tagged(rigs: Path) -> Iterator[bool]:
    """Share of clips of walks with the direction of their name: whole, activities, steps."""
    right = list[bool]()
    for path in few(sorted((rigs / "bandai_namco").glob("*_walk*.bvh")), []):
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
        kept = "kept" if share >= FEWEST else "NOT KEPT"
        print(f"direction of {len(right)} clips of walks tagged rightly: {share:.1f} %")
        print(f"at least {FEWEST:g} % promised: {kept}")
        record("clips.tagged", round(share, 1), unit="%")
        yield share >= FEWEST


def cost(rigs: Path, folder: Path) -> Iterator[bool]:
    """What a library of the clips takes: built, and the best loops of all written."""
    recordings = few(sorted((rigs / "bandai_namco").glob("*.bvh")), [])
    if recordings:
        home, library = rigs / "bandai_namco", folder / "library"
        commands = {
            "build": ("library", "build", home, "--into", library, "--jobs", 1, "-q"),
            "split": ("library", "split", library, "--best", 3, "-o", folder / "loops"),
        }
        for name, command in commands.items():
            _, used_s, _ = run_kineme(*command)
            each = used_s / len(recordings)
            print(f"library {name}: {each:.2f} CPU s for each of {len(recordings)} recordings")
            record(f"clips.{name}", round(used_s / len(recordings), 2), unit="CPU s")
    yield True


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
