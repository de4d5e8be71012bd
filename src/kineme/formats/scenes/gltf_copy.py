"""Copy a glTF file with other animations, keeping meshes, skins, materials and everything else.

Nodes, meshes and accessors keep their numbers, since extensions may refer to them. New animations
reuse the numbers freed by the old ones. Bytes used only by old animations are dropped. Nodes that
are not joints of the character are at rest in the new animations.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from mimetypes import guess_type
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.checks import warn
from kineme._util.files import translate_read_errors
from kineme._util.json import decode_json
from kineme.errors import ReadError, WriteError
from kineme.formats.files import load
from kineme.formats.scenes.assembly import compose
from kineme.formats.scenes.gltf_file import GLTFFile
from kineme.formats.scenes.gltf_writer import (
    Animator,
    check_copy,
    describe_transform,
    save_gltf,
)
from kineme.recordings import Motion
from kineme.recordings.posing import get_rig
from kineme.recordings.rig import Rig

_COMPRESSION = "EXT_meshopt_compression"


def copy_animations(motions: Mapping[str, Motion], source: Path, path: Path) -> None:
    """Write a copy of ``source``, the file of the motions, with the motions as its animations."""
    skeleton = check_copy(motions, source, path)
    rig = get_rig(skeleton)
    with translate_read_errors(source):
        file = GLTFFile(load(source))
        tree: dict[str, Any] = decode_json(file.text, source, dict)
    numbers = list(rig.numbers)
    if max(numbers) >= len(tree["nodes"]):
        raise WriteError(path, f"{source.name} has changed since it was read")
    if _COMPRESSION in tree.get("extensionsUsed", ()):
        raise WriteError(
            path,
            f"the buffers of {source.name} are compressed by meshopt: export it without "
            "compression",
        )
    copy = Animator(skeleton, rig, numbers[rig.above :], tree)
    _drop_animations(copy, file)
    if numbers[rig.above] < 0:
        copy.numbers = [_add_root(copy, file, rig), *numbers[rig.above + 1 :]]
    _embed_images(copy, file)
    for name, motion in motions.items():
        copy.animate(name, motion)
    _close_number_gaps(copy)
    save_gltf(tree, bytes(copy.data), path)


def _drop_animations(copy: Animator, file: GLTFFile) -> None:
    """Remove the animations, and copy the bytes of all other data into one buffer."""
    tree = copy.tree
    tree.setdefault("bufferViews", [])
    tree.setdefault("accessors", [])
    samplers = [each for animation in tree.get("animations", ()) for each in animation["samplers"]]
    keys = {each[end] for each in samplers for end in ("input", "output")}
    # Accessors shared with skins or meshes must stay.
    keys -= {skin.get("inverseBindMatrices") for skin in tree.get("skins", ())}
    for mesh in tree.get("meshes", ()):
        for part in mesh["primitives"]:
            used = [part["attributes"], *part.get("targets", ())]
            keys -= {number for table in used for number in table.values()} | {part.get("indices")}
    needed: set[int] = set()
    dropped: set[int] = set()
    for number, accessor in enumerate(tree["accessors"]):
        views = [accessor, *accessor.get("sparse", {}).values()]
        views_of_accessor = {
            each["bufferView"] for each in views if isinstance(each, dict) and "bufferView" in each
        }
        (dropped if number in keys else needed).update(views_of_accessor)
    # Views used only by the dropped accessors are free, too.
    copy.free_accessors, copy.free_views = sorted(keys), sorted(dropped - needed)
    for number, view in enumerate(tree["bufferViews"]):
        if number in copy.free_views:
            continue
        start = view.get("byteOffset", 0)
        stored = file.read_buffer(view["buffer"])[start : start + view["byteLength"]]
        if len(stored) < view["byteLength"]:
            raise ReadError(file.content.path, f"buffer view {number} is longer than its buffer")
        view |= {"buffer": 0, "byteOffset": len(copy.data)}
        # Views must start at multiples of four bytes.
        copy.data += stored + bytes(-len(stored) % 4)
    tree["animations"] = []


def _close_number_gaps(copy: Animator) -> None:
    """Drop unused numbers at the end, and put placeholders at unused numbers in between."""
    view = {"buffer": 0, "byteLength": 4}
    accessor = {"componentType": 5126, "count": 1, "type": "SCALAR"}
    for name, free, part in (
        ("accessors", copy.free_accessors, accessor),
        ("bufferViews", copy.free_views, view),
    ):
        parts = copy.tree[name]
        # Numbers at the end can be dropped without changing others.
        while free and free[-1] == len(parts) - 1:
            parts.pop()
            free.pop()
        for number in free:
            parts[number] = dict(part)


def _add_root(copy: Animator, file: GLTFFile, rig: Rig) -> int:
    """Add the rig's root bone as a node and to the skins of its children; return its number."""
    tree, root = copy.tree, rig.above
    new = len(tree["nodes"])
    children = [rig.numbers[node] for node, parent in enumerate(rig.parents) if parent == root]
    if root:
        siblings = tree["nodes"][rig.numbers[root - 1]]["children"]
        siblings[:] = [*(each for each in siblings if each not in children), new]
    for scene in tree.get("scenes", ()) if not root else ():
        if {*scene.get("nodes", ())} & {*children}:
            scene["nodes"] = [*(each for each in scene["nodes"] if each not in children), new]
    tree["nodes"].append(
        {"name": rig.names[root], **describe_transform(rig, root), "children": children}
    )
    bind = np.linalg.inv(compose(*(part[root : root + 1] for part in rig.world)))[0]
    bind[3] = [0.0, 0.0, 0.0, 1.0]  # required exactly by glTF
    for skin in tree.get("skins", ()):
        if not {*skin["joints"]} & {*children}:
            continue
        skin["joints"].append(new)
        if "inverseBindMatrices" in skin:
            matrices = file.read_array(skin["inverseBindMatrices"])
            matrices = np.concatenate([matrices, bind.T.reshape(1, 16)])
            skin["inverseBindMatrices"] = copy.add_accessor(matrices, None)
    return new


def _embed_images(copy: Animator, file: GLTFFile) -> None:
    """Embed images that are files next to the source, since the copy may be in another folder."""
    for image in copy.tree.get("images", ()):
        uri = image.get("uri", "data:")
        if uri.startswith("data:"):
            continue
        try:
            stored = base64.b64encode(file.read_uri(uri)).decode()
        except ReadError:
            warn(f"{file.content.path.name}: the texture {uri!r:.60} is missing")
            continue
        image["uri"] = f"data:{guess_type(uri)[0] or 'image/png'};base64,{stored}"
