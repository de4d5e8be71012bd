"""USD: written files read back, and other stages are read."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.errors import ReadError, SeveralPeopleError, WriteError
from kineme.formats import read_motion, read_quietly, write
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_world_rotations

pytest.importorskip("pxr")

from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

TURN = Gf.Quatf(0.5**0.5, 0, 0, 0.5**0.5)  # by 90 degrees about z; w first
NONE = Gf.Quatf(1, 0, 0, 0)


@pytest.mark.parametrize("suffix", [".usda", ".usd"])
def test_what_is_written_is_read_again(tmp_path: Path, suffix: str) -> None:
    motion = read_motion(kineme.bundled_recording())[:90]
    write(motion, tmp_path / f"a{suffix}")
    again = read_motion(tmp_path / f"a{suffix}")
    assert again.skeleton.names == motion.skeleton.names
    assert again.skeleton.end_sites == motion.skeleton.end_sites
    assert np.abs(again.positions - motion.positions).max() < 1e-5
    assert again.fps == motion.fps
    ours = compute_world_rotations(motion.skeleton, motion.rotations)
    theirs = compute_world_rotations(again.skeleton, again.rotations)
    assert np.abs(np.einsum("fjc,fjc->fj", ours, theirs)).min() > 1 - 1e-6
    assert again.provenance.format == "USD"


def test_names_that_paths_cannot_have_and_a_rate_that_is_not_whole(tmp_path: Path) -> None:
    skeleton = Skeleton(("rig:Hips", "Left Leg", "Left_Leg", "é"), (-1, 0, 0, 0), np.eye(4, 3))
    rotations = np.tile([1.0, 0, 0, 0], (5, 4, 1))
    motion = Motion.from_rotations(skeleton, rotations, 29.97, np.arange(15).reshape(5, 3))
    write(motion, tmp_path / "a.usda")
    again = read_motion(tmp_path / "a.usda")
    assert again.skeleton.names == skeleton.names
    assert again.skeleton.parents == skeleton.parents
    assert again.fps == pytest.approx(29.97)
    assert np.abs(again.positions - motion.positions).max() < 1e-5
    with pytest.raises(WriteError, match="a USD needs rotations"):
        write(Motion(skeleton, motion.positions, 30), tmp_path / "b.usda")


def add_skeleton(stage: Usd.Stage, place: str) -> UsdSkel.Skeleton:
    """Hips and a leg of 40, under a root that is 100 aside."""
    root = UsdSkel.Root.Define(stage, place)
    UsdGeom.XformCommonAPI(root).SetTranslate((100.0, 0.0, 0.0))
    skeleton = UsdSkel.Skeleton.Define(stage, f"{place}/Skeleton")
    skeleton.CreateJointsAttr(["Hips", "Hips/Leg", "Hips/Leg/Toe_end"])
    down = [(0, 0, 90), (0, 0, -40), (0, 0, -40)]
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d().SetTranslate(Gf.Vec3d(*at)) for at in down])
    return skeleton


def animate(stage: Usd.Stage, skeleton: UsdSkel.Skeleton, name: str, codes: list[float]) -> None:
    """The leg turns by 90 degrees; all the time."""
    path = skeleton.GetPath().AppendChild(name)
    animation = UsdSkel.Animation.Define(stage, path)
    animation.CreateJointsAttr(["Hips/Leg"])
    for code in codes:
        share = (code - codes[0]) / (codes[-1] - codes[0])
        turn = Gf.Slerp(share, NONE, TURN)
        animation.CreateRotationsAttr().Set(Vt.QuatfArray([turn]), code)
    binding = UsdSkel.BindingAPI.Apply(skeleton.GetPrim())
    if not binding.GetAnimationSourceRel().GetTargets():
        binding.CreateAnimationSourceRel().SetTargets([path])


def new_stage(path: Path) -> Usd.Stage:
    stage = Usd.Stage.CreateNew(str(path))
    stage.SetTimeCodesPerSecond(24)
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    return stage


def test_units_axes_carriers_and_joints_that_rest(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    skeleton = add_skeleton(stage, "/Ann")
    animate(stage, skeleton, "wave", [10.0, 12.0, 14.0, 16.0])
    stage.Save()
    motion = read_motion(tmp_path / "a.usda")
    assert (motion.n_frames, motion.fps) == (4, 12)
    assert motion.skeleton.names == ("Hips", "Leg", "Toe_end")
    assert motion.skeleton.end_sites == {2}
    assert motion.positions[0] == pytest.approx(
        np.array([[1, 0.9, 0], [1, 0.5, 0], [1, 0.1, 0]]), abs=1e-6
    )
    finer = read_motion(tmp_path / "a.usda", fps=24)
    assert finer.n_frames == 7
    assert finer.positions[::2] == pytest.approx(motion.positions, abs=1e-6)


def test_several_animations_and_characters(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    ann = add_skeleton(stage, "/Ann")
    animate(stage, ann, "wave", [0.0, 1.0, 2.0])
    animate(stage, ann, "bow", [0.0, 1.0, 2.0, 3.0, 4.0])
    stage.Save()
    with pytest.warns(kineme.KinemeWarning, match="2 takes are in it and 'wave' is read"):
        assert kineme.read(tmp_path / "a.usda").n_frames == 3
    assert kineme.read(tmp_path / "a.usda", take="bow").n_frames == 5
    animate(stage, add_skeleton(stage, "/Bob"), "run", [0.0, 1.0])
    stage.Save()
    with pytest.raises(SeveralPeopleError, match=r"Ann \(3 joints\), Bob"):
        read_quietly(tmp_path / "a.usda")


def test_stages_without_a_skeleton_and_damaged_ones(tmp_path: Path) -> None:
    new_stage(tmp_path / "a.usda").Save()
    with pytest.raises(ReadError, match="has no skeleton"):
        read_quietly(tmp_path / "a.usda")
    stage = new_stage(tmp_path / "b.usda")
    add_skeleton(stage, "/Ann")
    stage.Save()
    with pytest.raises(ReadError, match="holds no animation of its skeleton"):
        read_quietly(tmp_path / "b.usda")
    motion = read_motion(kineme.bundled_recording())[:9]
    write(motion, tmp_path / "c.usdc")
    (tmp_path / "c.usdc").write_bytes((tmp_path / "c.usdc").read_bytes()[:3000])
    with pytest.raises(ReadError, match="is not a complete USD file: truncated or damaged"):
        read_quietly(tmp_path / "c.usdc")


def test_without_the_package_it_is_named(tmp_path: Path) -> None:
    write(read_motion(kineme.bundled_recording())[:2], tmp_path / "a.usda")
    program = (
        "import sys; sys.modules['pxr'] = None; import kineme\n"
        "try: kineme.read(sys.argv[1])\n"
        "except kineme.KinemeError as error: print(error)"
    )
    command = [sys.executable, "-c", program, str(tmp_path / "a.usda")]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=os.environ)
    assert "pip install 'kineme[usd]'" in done.stdout


HEAD = "#usda 1.0\n"


@pytest.fixture
def character(tmp_path: Path) -> Path:
    """A character of 9 frames in a folder below another."""
    path = tmp_path / "scene" / "parts" / "char.usda"
    path.parent.mkdir(parents=True)
    write(read_motion(kineme.bundled_recording())[:9], path)
    return path


def refer_to(place: str | Path) -> str:
    return f'{HEAD}def "A" (references = @{place}@</char>) {{}}\n'


@pytest.mark.parametrize(
    "text",
    [
        refer_to("./parts/char.usda"),
        refer_to("parts/char.usda"),
        f'{HEAD}def "A" (payload = @parts/char.usda@</char>) {{}}\n',
        f"{HEAD}(subLayers = [@parts/char.usda@])\n",
    ],
)
def test_layers_in_the_folder_of_a_stage_are_part_of_it(character: Path, text: str) -> None:
    scene = character.parent.parent / "scene.usda"
    scene.write_text(text)
    motion = read_motion(scene, unit="m")
    assert (motion.n_frames, motion.provenance.warnings) == (9, ())
    assert np.abs(motion.positions - read_motion(character).positions).max() < 1e-6


def test_layers_from_elsewhere_are_refused(character: Path, tmp_path: Path) -> None:
    folder = character.parent.parent
    outside = character.rename(tmp_path / "char.usda")
    (folder / "link.usda").symlink_to(outside)
    (folder / "folder").symlink_to(tmp_path)
    places = [outside, "../char.usda", "parts/../../char.usda", "link.usda", "folder/char.usda"]
    for place in places:
        (folder / "scene.usda").write_text(refer_to(place))
        with pytest.raises(ReadError, match="which is outside its folder"):
            read_quietly(folder / "scene.usda")
    # What a layer in the folder names is held to the same folder.
    (folder / "between.usda").write_text(f"{HEAD}(subLayers = [@../char.usda@])\n")
    (folder / "scene.usda").write_text(f"{HEAD}(subLayers = [@between.usda@])\n")
    with pytest.raises(ReadError, match="which is outside its folder"):
        read_quietly(folder / "scene.usda")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no pipes in folders")
def test_a_layer_that_is_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.usda")
    (tmp_path / "a.usda").write_text(refer_to("pipe.usda"))
    with pytest.raises(ReadError, match="is a pipe or a device"):
        read_quietly(tmp_path / "a.usda")
    stage = Usd.Stage.CreateNew(str(tmp_path / "b.usda"))
    variants = stage.DefinePrim("/A").GetVariantSets().AddVariantSet("kind")
    variants.AddVariant("one")
    variants.SetVariantSelection("one")
    with variants.GetVariantEditContext():
        UsdGeom.Xform.Define(stage, "/A/B")
    stage.Save()
    text = (tmp_path / "b.usda").read_text()
    text = text.replace('def Xform "B"', 'def Xform "B" (payload = @./pipe.usda@)')
    assert "pipe" in text
    (tmp_path / "c.usda").write_text(text)
    with pytest.raises(ReadError, match="is a pipe or a device"):
        read_quietly(tmp_path / "c.usda")


def test_missing_layers_are_left_out_with_a_warning(
    character: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(character.parent)  # where the library would find it
    scene = character.parent.parent / "scene.usda"
    scene.write_text(f"{HEAD}(subLayers = [@parts/char.usda@, @char.usda@])\n")
    motion = read_quietly(scene)
    assert motion.n_frames == 9
    assert motion.provenance.warnings == (
        "the layer 'char.usda' is missing or not USD, so it is left out",
    )
    scene.write_text(refer_to("char.usda"))
    with pytest.raises(ReadError, match=r"has no skeleton.*'char\.usda' is missing"):
        read_quietly(scene)


def test_what_the_library_prints_becomes_a_warning(
    character: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    scene = character.parent.parent / "scene.usda"
    scene.write_text(
        f"{HEAD}(subLayers = [@parts/char.usda@])\n"
        'def "B" (references = [</nowhere>, </C>]) {}\ndef "C" (references = </B>) {}\n'
    )
    with pytest.warns(kineme.KinemeWarning, match=r"the USD library warns: In </[BC]>") as caught:
        assert kineme.read(scene).n_frames == 9
    assert "\n" not in str(caught[0].message)
    assert capfd.readouterr() == ("", "")


def nest(depth: int) -> str:
    """Each level holds the next one four times."""
    inner = [f'def "c{k}" (references = </L%d>) {{}}' for k in range(4)]
    lines = [
        f'def "L{d}" {{\n' + "\n".join(line % (d + 1) for line in inner) + "\n}"
        for d in range(depth)
    ]
    return "\n".join([HEAD, *lines, f'def "L{depth}" {{}}'])


def double(depth: int) -> str:
    """Each prim of a level is made of both of the next one."""
    lines = [
        f'def "P{d}{k}" (references = [</P{d + 1}a>, </P{d + 1}b>]) {{}}'
        for d in range(depth)
        for k in "ab"
    ]
    return "\n".join([HEAD, *lines, f'def "P{depth}a" {{}}', f'def "P{depth}b" {{}}'])


def chain(depth: int) -> str:
    lines = [f'def "P{d}" (references = </P{d + 1}>) {{}}' for d in range(depth)]
    return "\n".join([HEAD, *lines, f'def "P{depth}" {{}}'])


@pytest.mark.parametrize("text", [nest(30), double(30), chain(600)])
def test_references_that_multiply_are_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.usda").write_text(text)
    with pytest.raises(ReadError, match="its references expand to more than 100000 prims"):
        read_quietly(tmp_path / "a.usda")


def test_sublayers_that_multiply_are_refused(tmp_path: Path) -> None:
    for d in range(20):
        for k in "ab":
            text = f"{HEAD}(subLayers = [@L{d + 1}a.usda@, @L{d + 1}b.usda@])\n"
            (tmp_path / f"L{d}{k}.usda").write_text(text if d < 19 else HEAD)
    with pytest.raises(ReadError, match="its sublayers expand to more than"):
        read_quietly(tmp_path / "L0a.usda")


def test_a_file_that_crashes_the_library_is_an_error(tmp_path: Path) -> None:
    depth = 200_000
    (tmp_path / "a.usda").write_text(HEAD + 'def "a" {\n' * depth + "}\n" * depth)
    with pytest.raises(ReadError, match="the USD library crashed or ran out of memory"):
        read_quietly(tmp_path / "a.usda")


def test_clips_of_values_which_are_files_are_refused(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "a.usda")
    animate(stage, add_skeleton(stage, "/Ann"), "wave", [0.0, 1.0])
    Usd.ClipsAPI(stage.GetPrimAtPath("/Ann")).SetClipAssetPaths(["/elsewhere.usda"])
    stage.Save()
    with pytest.raises(ReadError, match="has its animation in value clips"):
        read_quietly(tmp_path / "a.usda")
