"""Build small FBX scenes with a chain of bones, and read them."""

from __future__ import annotations

from pathlib import Path

from _fbx import Keys, Scene
from kineme.formats import read_quietly
from kineme.formats.options import ReadOptions
from kineme.recordings import Motion


def read_scene(data: bytes, folder: Path, **options: object) -> Motion:
    path = folder / "a.fbx"
    path.write_bytes(data)
    motion = read_quietly(path, ReadOptions(**options))  # type: ignore[arg-type]
    assert isinstance(motion, Motion)
    return motion


class Bones(Scene):
    """A scene with a chain of bones a, b, c on ``top``, and a take of one second."""

    def __init__(self, said: dict[str, dict[str, object]], **settings: object) -> None:
        super().__init__(**{"UnitScaleFactor": 100.0, **settings})  # metres
        self.models: dict[str, int] = {}
        parent = 0
        for name in ("top", "a", "b", "c"):
            kind = "Null" if name == "top" else "LimbNode"
            self.models[name] = parent = self.model(name, parent, kind, **said.get(name, {}))


def make_bone(**said: object) -> Bones:
    return Bones({"a": {"LclTranslation": [0.0, 1.0, 0.0]}, "b": said,
                  "c": {"LclTranslation": [0.0, 0.0, 0.5]}})  # fmt: skip


def animate_turn(scene: Scene, *models: int, stop: float = 1) -> None:
    """Add a take in which models turn by 90 degrees about x."""
    layer = scene.layer(scene.take("take", 0, stop))
    for model in models:
        scene.animate(layer, model, "R", X=Keys([0, stop], [0, 90]))


def play(scene: Bones, folder: Path, what: str = "R", node: str = "b", **axes: Keys) -> Motion:
    layer = scene.layer(scene.take("take", 0, 1))
    rest = (1, 1, 1) if what == "S" else (0, 0, 0)
    scene.animate(layer, scene.models[node], what, rest, **axes)
    return read_scene(scene.binary(), folder)
