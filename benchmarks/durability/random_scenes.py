"""FBX of random transforms, keys and layers: joints where ufbx has them.

    python -m benchmarks random_scenes --ufbx FOLDER [--record]

FOLDER holds ``ufbx.c`` and ``ufbx.h`` (S. Raivio's reader in C; the package ``pufbx`` brings them),
which are compiled with ``cc``. Each scene has six bones with rotation orders, pre- and
post-rotations, pivots and inherited scales drawn at random, curves of constant, linear and cubic
keys, and up to three layers on the first; every fifth is written as text, the others as binary of
four versions. A third has scales that differ by axis, a third such as change.

Left out is what ufbx does not know or does in a way of its own: tangents of Kochanek and Bartels,
automatic ones that depend on time, layers in which a model has a translation without a rotation.

Promises: joints within a hundred-thousandth of the size of the scene.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import _fbx
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few, skip
from kineme.formats import read_motion

SCENES = few(200, 5)
SECONDS, FPS = 2.0, 30
MOST = 1e-5
VERSIONS = (7400, 7700, 7100, 7500)
FLAGS = (0x4, 0x2, 0x102, 0x8 | 0x400, 0x8 | 0x6100, 0x8 | 0x400 | 0x3000000)
PROGRAM = r"""
#include "ufbx.h"
#include <stdio.h>
#include <stdlib.h>
int main(int count, char **words) {
  ufbx_error error;
  ufbx_scene *scene = ufbx_load_file(words[1], NULL, &error);
  if (!scene) return 1;
  const ufbx_anim *anim = scene->anim_stacks.data[0]->anim;
  for (int k = 0; k < atoi(words[3]); k++) {
    ufbx_scene *now = ufbx_evaluate_scene(scene, anim, k / atof(words[2]), NULL, &error);
    for (size_t i = 1; i < now->nodes.count; i++) {
      ufbx_vec3 at = now->nodes.data[i]->node_to_world.cols[3];
      printf("%s %.9g %.9g %.9g\n", now->nodes.data[i]->name.data, at.x, at.y, at.z);
    }
    ufbx_free_scene(now);
  }
  return 0;
}
"""


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("--ufbx", default=os.environ.get("KINEME_UFBX"), metavar="FOLDER")
    add_option(parser)
    given = parser.parse_args()
    if not given.ufbx:
        skip("needs the source of ufbx: name its folder with --ufbx, or in KINEME_UFBX")
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        program = compiled(Path(given.ufbx), place)
        for seed in range(SCENES):
            scene = random_scene(seed)
            version = VERSIONS[seed % len(VERSIONS)]
            data = scene.text() if seed % 5 == 4 else scene.binary(version, packed=seed % 2 == 0)
            path = place / "scene.fbx"
            path.write_bytes(data)
            away = difference(path, program)
            if away > MOST:
                print(f"scene {seed}: {away:.2g} of its size away")
            worst = max(worst, away)
    print(f"{SCENES} scenes: share of their size {verdict(worst, MOST)}: {worst:.1e}")
    record("random_scenes.scenes", SCENES)
    record("random_scenes.share", float(f"{worst:.1e}"))
    return int(worst > MOST)


def compiled(source: Path, place: Path) -> Path:
    """The program that tells where ufbx has the nodes of a file."""
    (place / "places.c").write_text(PROGRAM)
    program = place / "places"
    command = ["cc", "-O1", f"-I{source}", str(place / "places.c"), str(source / "ufbx.c")]
    subprocess.run([*command, "-lm", "-o", str(program)], check=True)
    return program


def difference(path: Path, program: Path) -> float:
    """How far a joint is at most from where ufbx has it, as a share of the largest coordinate."""
    motion = read_motion(path, unit=1.0)
    command = [str(program), str(path), str(FPS), str(motion.n_frames)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    places: dict[str, list[list[float]]] = {}
    for line in done.stdout.splitlines():
        name, *at = line.split()
        places.setdefault(name, []).append(list(map(float, at)))
    theirs = np.array([places[name] for name in motion.skeleton.names]).swapaxes(0, 1)
    return float(np.abs(motion.positions - theirs).max() / max(1.0, np.abs(theirs).max()))


def random_scene(seed: int) -> _fbx.Scene:
    """A chain or tree of six bones below a null."""
    rng = np.random.default_rng(seed)
    scene = _fbx.Scene(TimeMode=6)
    take = scene.take("take", 0.0, SECONDS)
    layers = [scene.layer(take)]
    carrier = {"LclScaling": [2.0] * 3} if seed % 3 == 0 else {}
    models = [scene.model("top", 0, "Null", LclTranslation=vector(rng, 10), **carrier)]
    for j in range(6):
        parent = models[int(rng.integers(1, len(models)))] if j else models[0]
        models.append(scene.model(f"j{j}", parent, **random_transform(rng, seed)))
    for number in range(seed % 4):
        modes = {
            "Weight": float(rng.choice([100.0, 60.0])),
            "BlendMode": int(rng.integers(3)),
            "RotationAccumulationMode": int(rng.integers(2)),
        }
        layers.append(scene.layer(take, f"L{number}", **modes))
    for layer in layers:
        for model in models:
            if rng.random() < 0.2:
                continue
            scene.animate(layer, model, "R", vector(rng, 30), **random_curves(rng, 40))
            if rng.random() < 0.5:
                scene.animate(layer, model, "T", vector(rng, 9), **random_curves(rng, 10))
            if seed % 3 == 2 and layer == layers[0] and model != models[0]:
                scene.animate(layer, model, "S", (1, 1, 1), **random_curves(rng, 0.1, 1.0))
    return scene


def random_transform(rng: np.random.Generator, seed: int) -> dict[str, object]:
    """What a bone says; scales are one number each, differ by axis, or change."""
    said: dict[str, object] = {
        "LclTranslation": vector(rng, 20),
        "LclRotation": vector(rng, 60),
        "RotationOrder": int(rng.integers(6)),
        "InheritType": int(rng.integers(3)) if seed % 3 == 0 else seed % 2,
    }
    for name in ("PreRotation", "PostRotation"):
        if rng.random() < 0.5:
            said[name] = vector(rng, 50)
    for name in ("RotationPivot", "RotationOffset", "ScalingPivot", "ScalingOffset"):
        if rng.random() < 0.4:
            said[name] = vector(rng, 5)
    if seed % 3 < 2:
        scale = rng.uniform(0.5, 2, 3 if seed % 3 else 1)
        said["LclScaling"] = [float(x) for x in np.broadcast_to(scale, 3)]
    return said


def vector(rng: np.random.Generator, size: float) -> list[float]:
    return [float(x) for x in size * rng.normal(size=3)]


def random_curves(rng: np.random.Generator, size: float, rest: float = 0.0) -> dict[str, _fbx.Keys]:
    """Some of the axes, with keys of all kinds."""
    curves = {}
    for axis in "XYZ":
        if rng.random() < 0.2:
            continue
        n = int(rng.integers(1, 8))
        times = np.sort(rng.choice(60, n, replace=False)) / FPS + rng.choice([0, 0.011])
        flags = [int(flag) for flag in rng.choice(FLAGS, n)]
        slopes = [
            (*(size * rng.normal(size=2)), 0, 0) if f & 0x400 else (0, 0, 0, 0) for f in flags
        ]
        weights = [(float(a), float(b)) for a, b in rng.uniform(0.05, 0.95, (n, 2))]
        values = rest + size * rng.normal(size=n)
        curves[axis] = _fbx.Keys(times.tolist(), values.tolist(), flags, slopes, weights)
    return curves


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
