"""Write USD: a skeleton and its animation (UsdSkel), ``.usda``, ``.usdc`` or ``.usd``.

Lengths are metres, y is up. A time code is a frame, and time codes per second are the frame rate.
The rest pose is that of the motion's rig. ``jointNames`` hold the original names; in paths they
are reduced to letters, digits and ``_``. The custom data of the skeleton list the end sites. Needs
``usd-core``.

Source: Pixar, "UsdSkel: schemas and API", OpenUSD documentation.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import make_unique, require_extra
from kineme._util.files import atomic_write
from kineme.errors import WriteError
from kineme.formats.files import clean_names, require_rotations
from kineme.formats.plausibility import warn_of_gaps
from kineme.formats.scenes.assembly import compose
from kineme.recordings import Motion
from kineme.recordings.posing import get_rig, pose_rig

END_SITES = "kineme:endSites"


def write_usd(motion: Motion, path: Path) -> None:
    """Write a motion to a USD file."""
    require_rotations(motion, path, "a USD")
    with require_extra("usd-core", "usd"):
        from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdSkel, Vt
    warn_of_gaps([motion], path)
    skeleton = motion.skeleton
    names = clean_names(path, skeleton.names, str.strip)
    # Paths need unique identifiers.
    words = make_unique(Tf.MakeValidIdentifier(name) for name in names)
    joints: list[str] = []
    for word, parent in zip(words, skeleton.parents, strict=True):
        joints.append(word if parent < 0 else f"{joints[parent]}/{word}")
    stage = Usd.Stage.CreateInMemory()
    # Programs interpret transforms above the skeleton differently, so merge them into the root.
    rig = get_rig(skeleton).join_root().to_metres()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(motion.fps)
    stage.SetFramesPerSecond(motion.fps)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(motion.n_frames - 1)
    top = Sdf.Path(f"/{Tf.MakeValidIdentifier(path.stem)}")
    root = UsdSkel.Root.Define(stage, top)
    stage.SetDefaultPrim(root.GetPrim())
    bound = UsdSkel.Skeleton.Define(stage, top.AppendChild("Skeleton"))
    bound.CreateJointsAttr(joints)
    bound.CreateJointNamesAttr(names)
    local = compose(rig.translations, rig.rotations, rig.scales)
    world = compose(*rig.world)
    bound.CreateRestTransformsAttr([_to_usd_matrix(Gf, each) for each in local])
    bound.CreateBindTransformsAttr([_to_usd_matrix(Gf, each) for each in world])
    ends = [names[j] for j in sorted(skeleton.end_sites)]
    bound.GetPrim().SetCustomDataByKey(END_SITES, Vt.StringArray(ends))
    animation = UsdSkel.Animation.Define(stage, bound.GetPath().AppendChild("Animation"))
    animation.CreateJointsAttr(joints)
    sizes = [Gf.Vec3h(*scale) for scale in rig.scales.tolist()]
    animation.CreateScalesAttr(Vt.Vec3hArray(sizes))
    shifts, turns = pose_rig(motion, rig)
    shifts, turns = shifts.astype("f4"), np.roll(turns, -1, axis=-1).astype("f4")  # w last
    translations, rotations = animation.CreateTranslationsAttr(), animation.CreateRotationsAttr()
    for frame in range(motion.n_frames):
        translations.Set(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(shifts[frame])), frame)
        rotations.Set(Vt.QuatfArray.FromNumpy(np.ascontiguousarray(turns[frame])), frame)
    binding = UsdSkel.BindingAPI.Apply(bound.GetPrim())
    binding.CreateAnimationSourceRel().SetTargets([animation.GetPath()])
    with atomic_write(path) as draft:
        try:
            stage.Export(str(draft), addSourceFileComment=False)
        except Tf.ErrorException as error:
            raise WriteError(path, "cannot be written as USD") from error


def _to_usd_matrix(gf: Any, matrix: Floats) -> Any:
    """Return a matrix for column vectors as a matrix of USD, which uses row vectors."""
    return gf.Matrix4d(*matrix.T.ravel().tolist())
