"""Opening USD stages: which layers they may bring in, and how much these may grow to.

A layer names others by sublayers, references and payloads. These are taken from the file's own
folder only. References to prims that hold references themselves multiply, so what they bring in is
counted before a stage is composed of it.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from kineme.formats.files import MAX_EXPANSION, FileContent, find_sibling

SUFFIXES = (".usda", ".usdc", ".usd")

MOST_BROUGHT = 100_000
"""Sources of prims that references may bring in; so many take a second and 200 MB."""

MOST_SUBLAYERS = 1000

LEAST_MEMORY = 1 << 30
"""Bytes that composing any stage may take."""

LONGEST = 300.0
"""Seconds that reading any file may take."""


def open_stage(content: FileContent) -> tuple[Any, int]:
    """Open the stage of a file; return it and the bytes of the other layers.

    ReadError where it brings in a file from outside its folder, or too much.
    """
    from pxr import Usd

    layers, beside = _load_layers(content)
    _check_sublayers(content, layers)
    _check_growth(content, layers[0])
    return Usd.Stage.Open(layers[0]), beside


def _load_layers(content: FileContent) -> tuple[list[Any], int]:
    """Load the layer of the file and all that it brings in; return them and the others' bytes.

    What is missing is taken out with a warning: the library would look for it elsewhere.
    """
    from pxr import Sdf

    layers: dict[str, Any] = {}
    waiting, size = [os.path.abspath(content.path)], 0  # noqa: PTH100 (links are kept)
    while waiting:
        path = waiting.pop()
        if path in layers:
            continue
        size += Path(path).stat().st_size
        _limit_process(size)
        layers[path] = layer = Sdf.Layer.FindOrOpen(path)
        for name in filter(None, layer.GetCompositionAssetDependencies()):
            plain, _ = Sdf.Layer.SplitIdentifier(name)
            # As the library does: ".." goes back in the text, whether or not a link is there.
            place = os.path.normpath(Path(path).parent / plain)
            found = find_sibling(content, place)
            if found.is_file() and found.suffix.lower() in SUFFIXES:
                waiting.append(place)
            else:
                layer.UpdateCompositionAssetDependency(name, "")
                content.warn(f"the layer {name!r:.60} is missing or not USD: left out")
    return list(layers.values()), size - len(content.data)


def _check_sublayers(content: FileContent, layers: list[Any]) -> None:
    """ReadError where sublayers that hold sublayers make one layer of too many."""
    from pxr import Sdf

    for layer in layers:
        stack = [layer]
        # The list grows while it is gone through.
        for each in stack:
            stack += [Sdf.Layer.FindRelativeToLayer(each, name) for name in each.subLayerPaths]
            if len(stack) > MOST_SUBLAYERS:
                raise content.error(f"its sublayers multiply to more than {MOST_SUBLAYERS}")


def _check_growth(content: FileContent, layer: Any) -> None:
    """ReadError where references bring in too much, or values are in clips, which are files."""
    from pxr import Pcp, Sdf

    cache = Pcp.Cache(Pcp.LayerStackIdentifier(layer), "usd", True)
    waiting, brought = [Sdf.Path.absoluteRootPath], 0
    while waiting:
        path = waiting.pop()
        if path.IsPrimPath():
            cache.RequestPayloads([path], [])
        index, _ = cache.ComputePrimIndex(path)
        if any(spec.HasInfo("clips") for spec in index.primStack):
            raise content.error("has its animation in value clips: flatten the stage first")
        nodes = list(index.rootNode.children)  # one for each place that a reference leads to
        while nodes:
            nodes += nodes.pop().children
            brought += 1
            if brought > MOST_BROUGHT:
                raise content.error(
                    f"its references multiply to more than {MOST_BROUGHT} prims: export the "
                    "character by itself"
                )
        waiting += [path.AppendChild(name) for name in index.ComputePrimChildNames()[0]]


def _limit_process(size: int) -> None:
    """Limit this process to the memory that layers of so many bytes may take."""
    if sys.platform == "win32":
        return
    import resource

    memory = LEAST_MEMORY + MAX_EXPANSION * size
    for what, most in ((resource.RLIMIT_DATA, memory), (resource.RLIMIT_CORE, 0)):
        with suppress(OSError, ValueError):  # a limit that is lower already
            resource.setrlimit(what, (most, resource.getrlimit(what)[1]))
