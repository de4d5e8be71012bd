"""FBX files that cannot be read raise an error with a single-sentence reason."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest
from fbx_scenes import motion_of, one_bone, played

from _fbx import Keys, Scene, encode_binary, format_text, make_node
from kineme.errors import ReadError


def no_animation() -> bytes:
    scene = Scene()
    scene.model("Hips")
    scene.take("empty", 0, 1)
    return scene.binary()


def no_skeleton() -> bytes:
    scene = Scene()
    box = scene.model("Box", 0, "Mesh")
    scene.animate(scene.layer(scene.take("t", 0, 1)), box, "R", X=Keys([0, 1], [0, 90]))
    return scene.binary()


def old_text() -> bytes:
    header = make_node("FBXHeaderExtension", children=[make_node("FBXVersion", 6100)])
    return format_text([header], 6100)


def bomb() -> bytes:
    """A curve that says that it has a quarter of a milliard of keys."""
    data = bytearray(one_curve())
    struct.pack_into("<I", data, data.index(b"KeyTimel") + len(b"KeyTimel"), 250_000_000)
    return bytes(data)


def one_curve() -> bytes:
    scene = one_bone()
    layer = scene.layer(scene.take("take", 0, 1))
    scene.animate(layer, scene.models["b"], "R", X=Keys([0, 1], [0, 90]))
    return scene.binary()


def endless() -> bytes:
    scene = one_bone()
    layer = scene.layer(scene.take("take", 0, 1e6))
    scene.animate(layer, scene.models["b"], "R", X=Keys([0, 1e6], [0, 90]))
    return scene.binary()


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (no_animation(), "holds no animation of its skeleton: export it with"),
        (no_skeleton(), r"has no skeleton \(bones or animated nodes\)"),
        (old_text(), "is FBX 6.1, a format of before 2011: open it .* and export FBX 2014"),
        (encode_binary([], 6100), "is FBX 6.1, a format of before 2011"),
        (b"Kaydara FBX Binary  \x00\x1a\x00\x00", "the file ends in its header"),
        (one_curve()[:-400], "truncated"),
        (one_curve()[:300], "truncated"),
        (format_text(Scene().nodes())[:-3], "the '}' of 'Connections' is missing"),
        (b"; FBX 7.4.0 project file\nObjects: {\n}}\n", "there is one '}' too many"),
        (b"; FBX 7.4.0 project file\n3, 4\n", "line 2: a name expected, found b'3'"),
        (bomb(), "claims an array of 250000000 numbers"),
        (endless(), "claims 3 joints in 30000001 frames"),
    ],
)
def test_what_cannot_be_read_says_why(tmp_path: Path, data: bytes, reason: str) -> None:
    with pytest.raises(ReadError, match=reason):
        motion_of(data, tmp_path)


def test_circles_among_models_and_links_to_nothing(tmp_path: Path) -> None:
    scene = one_bone()
    a, b = scene.models["a"], scene.models["b"]
    scene.link("OO", a, b)
    scene.link("OO", 77, b)
    scene.link("OO", 0, 0)
    motion = played(scene, tmp_path, X=Keys([0, 1], [0, 90]))
    assert motion.skeleton.names == ("a", "b", "c")
