"""FBX, GLB and USD out of Blender and in it: joints where Blender has them.

    python -m benchmarks scenes --bpy PYTHON [--record]

PYTHON is one that has Blender as a package (``pip install bpy``, 5.0 for Python 3.11; it wants
an older numpy, so that it gets an environment of its own), or is named by ``KINEME_BPY``. Blender
imports the bundled recording and those of KINEME_DATA, exports them with both up axes, with axes
of bones turned, with three orders of rotations, with ends of limbs or without, with two takes and
with two characters beside a prop, and as GLB and USD (where ``usd-core`` is installed). kineme
reads what it wrote. GLB and USD files that kineme writes Blender reads. With ``--node FOLDER``, in
which ``npm install gltf-validator three`` was run, Khronos' validator finds no error in the GLB
files, and three.js has the joints where kineme has them.

Promises: joints within 0.01 mm and 0.01 degrees of Blender's own, in every take; no errors.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import warnings
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import verdict
from _options import DATA, command_line, few, skip
from kineme.formats import read_motion
from kineme.recordings import Motion
from kineme.recordings.kinematics import world_rotations

FRAMES = few(400, 20)
MOST_MM, MOST_DEGREES = 0.01, 0.01
BVH = few(("cmu_formats/02_01.bvh", "formats/aitviewer_sample.bvh"), ())
PROGRAM = Path(__file__).parents[1] / "_blender.py"
TO_Y = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From Blender's axes."""

WAYS: dict[str, dict[str, Any]] = {
    "y up": {},
    "z up": {"options": {"axis_up": "Z", "axis_forward": "Y"}},
    "z up, x ahead": {"options": {"axis_up": "Z", "axis_forward": "X"}},
    "bones along x": {"options": {"primary_bone_axis": "X", "secondary_bone_axis": "Y"}},
    "no ends": {"options": {"add_leaf_bones": False, "armature_nodetype": "ROOT"}},
    "units": {"options": {"apply_scale_options": "FBX_SCALE_UNITS", "global_scale": 1.0}},
    "all scaled": {"options": {"apply_scale_options": "FBX_SCALE_ALL"}},
    "xyz": {"rotations": "XYZ"},
    "zyx": {"rotations": "ZYX"},
    "yxz": {"rotations": "YXZ"},
    "glb": {"options": {"export_frame_range": True}},
}
if find_spec("pxr"):
    WAYS["usdc"] = {"options": {"export_animation": True}}


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--bpy", default=os.environ.get("KINEME_BPY"), metavar="PYTHON")
    parser.add_argument("--node", type=Path, metavar="FOLDER")
    add_option(parser)
    given = parser.parse_args()
    if not given.bpy:
        skip("needs a Python that has bpy: name it with --bpy, or in KINEME_BPY")
    sources = [kineme.bundled_recording(), *(DATA / name for name in BVH)]
    sources = [path for path in sources if path.exists()]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        jobs = [*export_jobs(place, sources), characters(place, sources), takes(place)]
        jobs += import_jobs(place, sources)
        blender(given.bpy, place, jobs)
        failed = False
        for suffix in (".fbx", ".glb", ".usdc"):
            worst = np.zeros(2)
            of_format = [job for job in jobs if job["path"].endswith(suffix)]
            if not of_format:
                continue
            for job in of_format:
                worst = np.maximum(worst, compared(job))
            away, turned = map(float, worst)
            print(f"{len(of_format)} files of {suffix}: mm {verdict(away, MOST_MM)}: {away:.5f}; "
                  f"degrees {verdict(turned, MOST_DEGREES)}: {turned:.5f}")  # fmt: skip
            record(f"scenes{suffix}.files", len(of_format))
            record(f"scenes{suffix}.mm", round(away, 5), unit="mm")
            record(f"scenes{suffix}.degrees", round(turned, 5), unit="degrees")
            failed |= away > MOST_MM or turned > MOST_DEGREES
        read = [job["path"] for job in jobs if job["task"] == "read"]
        ours = [path for path in read if path.endswith(".glb")]
        if given.node:
            errors = validated(given.node, ours)
            away = max(in_three(given.node, place, path) for path in ours)
            print(f"Khronos' validator, {len(ours)} files: errors {verdict(errors, 0)}: {errors}; "
                  f"three.js: mm {verdict(away, MOST_MM)}: {away:.5f}")  # fmt: skip
            record("scenes.glb.errors", errors)
            record("scenes.glb.three_mm", round(away, 5), unit="mm")
            failed |= errors > 0 or away > MOST_MM
    return int(failed)


def export_jobs(place: Path, sources: list[Path]) -> list[dict[str, Any]]:
    """One for each recording and each way of writing it."""
    jobs = []
    for source in sources:
        for name, how in WAYS.items():
            stem = place / f"{source.stem} {name}"
            suffix = f".{name}" if name in ("glb", "usdc") else ".fbx"
            usual = USUAL if suffix == ".fbx" else {}
            jobs.append(
                {
                    "task": "export",
                    "bvh": [str(source)],
                    "frames": FRAMES,
                    "path": f"{stem}{suffix}",
                    "poses": f"{stem}.npz",
                    **how,
                    "options": usual | how.get("options", {}),
                }
            )
    return jobs


def import_jobs(place: Path, sources: list[Path]) -> list[dict[str, Any]]:
    """Files that kineme writes of all recordings, for Blender to read."""
    jobs = []
    for source in sources:
        motion = read_motion(source)[:FRAMES]
        for suffix in (".glb", ".usdc") if "usdc" in WAYS else (".glb",):
            path = place / f"{source.stem} by kineme{suffix}"
            kineme.write(motion, path)
            jobs.append(
                {
                    "task": "read",
                    "path": str(path),
                    "poses": f"{path}.npz",
                    "frames": motion.n_frames,
                    "fps": motion.fps,
                    "first": 0,
                }
            )
    return jobs


def validated(folder: Path, paths: list[str]) -> int:
    """The errors that Khronos' validator finds in these files."""
    program = """
    const validator = require(process.argv[1] + "/node_modules/gltf-validator");
    const read = (path) => new Uint8Array(require("fs").readFileSync(path));
    const all = process.argv.slice(2).map((path) => validator.validateBytes(read(path)));
    Promise.all(all).then((reports) => console.log(
      reports.reduce((sum, report) => sum + report.issues.numErrors, 0)));
    """
    command = ["node", "-e", program, str(folder.resolve()), *paths]
    return int(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


THREE = """
(async () => {
  const [folder, path, output] = process.argv.slice(1);
  globalThis.self = globalThis;
  const three = await import(folder + "/node_modules/three/build/three.module.js");
  const place = folder + "/node_modules/three/examples/jsm/loaders/GLTFLoader.js";
  const { GLTFLoader } = await import(place);
  const fs = require("fs");
  const bytes = new Uint8Array(fs.readFileSync(path)).buffer;
  const file = await new GLTFLoader().parseAsync(bytes, "");
  const mixer = new three.AnimationMixer(file.scene);
  const action = mixer.clipAction(file.animations[0]);
  action.setLoop(three.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  let bones = [];
  file.scene.traverse((each) => { if (each.isSkinnedMesh) bones = each.skeleton.bones; });
  const found = Array.from(file.animations[0].tracks[0].times, (time) => {
    mixer.setTime(time);
    file.scene.updateMatrixWorld(true);
    return bones.map((bone) => bone.getWorldPosition(new three.Vector3()).toArray());
  });
  fs.writeFileSync(output, JSON.stringify(found));
})();
"""


def in_three(folder: Path, place: Path, path: str) -> float:
    """Millimetres by which three.js has the joints of a GLB elsewhere than kineme, at most."""
    output = place / "three.json"
    command = ["node", "-e", THREE, str(folder.resolve()), path, str(output)]
    subprocess.run(command, check=True, capture_output=True)
    found = np.array(json.loads(output.read_text()))
    return 1000 * float(np.abs(found - read_motion(path).positions).max())


def characters(place: Path, sources: list[Path]) -> dict[str, Any]:
    """Two characters beside a prop."""
    return {
        "task": "export",
        "bvh": [str(source) for source in (sources * 2)[:2]],
        "frames": FRAMES,
        "prop": True,
        "path": f"{place / 'two characters'}.fbx",
        "poses": f"{place / 'two characters'}.npz",
        "options": USUAL,
    }


def takes(place: Path) -> dict[str, Any]:
    """Two recordings of one body in a file."""
    motion = read_motion(kineme.bundled_recording())
    paths = [place / "walk.bvh", place / "jump.bvh"]
    for path, start in zip(paths, (0, FRAMES), strict=True):
        kineme.write(motion[start : start + FRAMES - start // 10], path)
    return {
        "task": "takes",
        "bvh": [str(path) for path in paths],
        "frames": FRAMES,
        "path": f"{place / 'two takes'}.fbx",
        "poses": f"{place / 'two takes'}.npz",
        "options": USUAL | {"bake_anim_use_all_actions": True},
    }


USUAL = {
    "bake_anim_use_nla_strips": False,
    "bake_anim_use_all_actions": False,
    "bake_anim_simplify_factor": 0.0,
}


def blender(python: str, place: Path, jobs: list[dict[str, Any]]) -> None:
    """Have Blender do them, in one process."""
    file = place / "jobs.json"
    file.write_text(json.dumps(jobs))
    done = subprocess.run(
        [python, str(PROGRAM), str(file)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(done.stdout[-2000:] + done.stderr[-2000:])


def compared(job: dict[str, Any]) -> tuple[float, float]:
    """Millimetres and degrees by which kineme and Blender differ at most; said."""
    held = np.load(job["poses"])
    bodies = sorted({key.partition("/")[0] for key in held})
    away = turned = 0.0
    for body in bodies:
        several = body if len(bodies) > 1 else None
        if job["task"] == "takes":
            motion = kineme.read(job["path"], take=body)
        else:
            motion = kineme.read(job["path"], person=several)
        names = held[f"{body}/names"].tolist()
        found = difference(motion, names, held[f"{body}/positions"], held[f"{body}/turns"])
        away, turned = max(away, found[0]), max(turned, found[1])
    name = Path(job["path"]).name
    print(f"{name:42} {motion.n_frames:5d} frames {away:10.6f} mm {turned:10.6f} degrees")
    return away, turned


def difference(
    motion: Motion, names: list[str], positions: np.ndarray, turns: np.ndarray
) -> tuple[float, float]:
    """Of joints from bones of these names: millimetres, and degrees since the first frame."""
    joints = [motion.joint(name) for name in names]
    if motion.n_frames != len(positions):
        sys.exit(f"{motion.n_frames} frames instead of {len(positions)}")
    away = np.abs(motion.positions[:, joints] - positions @ TO_Y.T).max()
    ours = matrices(world_rotations(motion.skeleton, motion.rotations)[:, joints])
    theirs = TO_Y @ turns
    left = ours @ ours[:1].swapaxes(2, 3)
    right = theirs @ theirs[:1].swapaxes(2, 3)
    apart = np.linalg.norm(left - right, axis=(2, 3)) / np.sqrt(2)  # of small angles
    return 1000 * float(away), float(np.degrees(apart.max()))


def matrices(rotations: np.ndarray) -> np.ndarray:
    w, x, y, z = np.moveaxis(rotations, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
