"""Clips in engines: Godot and three.js where they are installed, lists and scripts without them."""

from __future__ import annotations

import json
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import kineme
from kineme.clips.split import split
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from manifests import read_manifest

ENGINES = Path(__file__).parents[2] / "engines"
THREE = Path(kineme.__file__).parent / "web" / "pages" / "node_modules" / "three"
GODOT = shutil.which("godot3-server")
NODE = shutil.which("node")

PROGRAM = """
(async () => {
  const [folder, path] = process.argv.slice(1);
  globalThis.self = globalThis;
  const three = await import(folder + "/build/three.module.js");
  const { GLTFLoader } = await import(folder + "/examples/jsm/loaders/GLTFLoader.js");
  const bytes = new Uint8Array(require("fs").readFileSync(path)).buffer;
  const file = await new GLTFLoader().parseAsync(bytes, "");
  const bones = [];
  file.scene.traverse((each) => { if (each.isBone) bones.push(each.name); });
  const clips = file.animations.map((clip) => {
    const mixer = new three.AnimationMixer(file.scene);
    mixer.clipAction(clip).play();
    mixer.setTime(clip.duration / 2);
    return [clip.name, clip.duration];
  });
  console.log(JSON.stringify({ bones, clips: Object.fromEntries(clips) }));
})();
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, motion: Motion, truth: Segmentation) -> Path:
    """The best loops of the bundled recording in place, named, in a GLB."""
    place = tmp_path_factory.mktemp("engines") / "loops"
    options = {"loops": True, "best": 1, "root_motion": "in-place", "close": True, "format": "glb"}
    split(motion, truth, place, level="primitive", **options)
    return place


@pytest.mark.skipif(GODOT is None, reason="needs Godot: apt-get install godot3-server")
def test_godot_has_every_clip_and_every_bone(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "project.godot").write_text("config_version=4\n")
    for path in (*folder.iterdir(), *(ENGINES / "godot").glob("*.gd")):
        shutil.copy(path, tmp_path)
    environment = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin"}
    godot = [str(GODOT), "--path", str(tmp_path)]
    for more in (["--editor", "--quit"], ["--script", "check.gd"]):
        done = subprocess.run(
            [*godot, *more], capture_output=True, text=True, env=environment, timeout=120
        )
    line = next(line for line in done.stdout.splitlines() if line.startswith("FOUND "))
    found = json.loads(line.removeprefix("FOUND "))["exercises.glb"]
    clips = read_manifest(folder)
    assert found["clips"].keys() == {clip["take"] for clip in clips}
    for clip in clips:
        there = found["clips"][clip["take"]]
        assert there["loop"]
        assert there["length"] == pytest.approx(clip["round_s"], abs=1e-4)
    names = kineme.read(folder / "exercises.glb", take=clips[0]["take"]).skeleton.names
    plain = [name.lower() for name in names]  # Godot spells LeftForeArm as left_fore_arm
    assert sorted(bone.replace("_", "") for bone in found["bones"]) == sorted(
        name.replace("_", "") for name in plain
    )


@pytest.mark.skipif(NODE is None or not THREE.exists(), reason="needs node and three")
def test_three_has_every_clip_and_every_bone(folder: Path) -> None:
    command = [str(NODE), "-e", PROGRAM, str(THREE.resolve()), str(folder / "exercises.glb")]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)
    clips = read_manifest(folder)
    assert found["clips"].keys() == {clip["take"] for clip in clips}
    for clip in clips:
        assert found["clips"][clip["take"]] == pytest.approx(clip["round_s"], abs=1e-4)
    names = kineme.read(folder / "exercises.glb", take=clips[0]["take"]).skeleton.names
    assert sorted(found["bones"]) == sorted(names)


def test_the_list_for_motion_matching_has_every_clip(folder: Path, tmp_path: Path) -> None:
    script, output = ENGINES / "motion_matching.py", tmp_path / "list.json"
    command = [sys.executable, str(script), str(folder / "manifest.json"), str(output)]
    subprocess.run(command, check=True)
    told = json.loads(output.read_text(encoding="utf-8"))
    clips = read_manifest(folder)
    assert [each["sequence"] for each in told["clips"]] == [clip["name"] for clip in clips]
    for each, clip in zip(told["clips"], clips, strict=True):
        assert each["range_s"] == [0, clip["round_s"]]
        assert each["loop"]
        assert each["tags"] == [clip["label"], *clip["tags"]]
    (recording,) = told["recordings"]
    starts = [each["range_s"][0] for each in recording["ranges"]]
    assert starts == sorted(clip["start_s"] for clip in clips)


def test_the_script_for_unreal_says_what_the_manifest_says(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a stand-in for its module: what would be imported, and left in each sequence."""
    imported: list[str] = []
    markers: list[tuple[str, str, float]] = []
    tags: list[tuple[str, str, str]] = []

    class AnimSequence:
        def __init__(self, name: str) -> None:
            self.name = name

        def get_name(self) -> str:
            return self.name

    sequences = {clip["take"]: AnimSequence(clip["take"]) for clip in read_manifest(folder)}
    tools = SimpleNamespace(
        import_asset_tasks=lambda tasks: imported.extend(task.filename for task in tasks)
    )
    stand_in = SimpleNamespace(
        AnimSequence=AnimSequence,
        AssetImportTask=SimpleNamespace,
        AssetToolsHelpers=SimpleNamespace(get_asset_tools=lambda: tools),
        EditorAssetLibrary=SimpleNamespace(
            list_assets=lambda _, recursive: list(sequences),
            load_asset=sequences.get,
            set_metadata_tag=lambda each, *tag: tags.append((each.name, *tag)),
            save_loaded_asset=lambda _: True,
        ),
        AnimationLibrary=SimpleNamespace(
            set_root_motion_enabled=lambda *_: None,
            add_animation_notify_track=lambda *_: None,
            add_animation_sync_marker=lambda each, *more: markers.append((each.name, *more[:2])),
        ),
        log=lambda _: None,
        log_warning=pytest.fail,
    )
    monkeypatch.setitem(sys.modules, "unreal", stand_in)
    script = runpy.run_path(str(ENGINES / "unreal" / "import_clips.py"))
    found = script["main"](str(folder), "/Game/Takes")
    clips = read_manifest(folder)
    assert list(found) == [clip["name"] for clip in clips]
    assert imported == [str(folder / "exercises.glb")]
    spans = sum(len(spans) for clip in clips for spans in clip["planted"].values())
    assert len(markers) == spans
    assert (clips[0]["name"], "kineme_label", clips[0]["label"]) in tags
