"""Open USD stages, with limits on the layers they may include and on their size.

A layer includes others by sublayers, references and payloads. Only files in the folder of the main
file are allowed. References to prims with references multiply, so their number is checked before a
stage is composed.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from kineme.formats.files import MAX_EXPANSION, FileContent, find_sibling

SUFFIXES = (".usda", ".usdc", ".usd")

MAX_REFERENCES = 100_000
"""Maximum number of prims included by references; this many take a second and 200 MB."""

MAX_SUBLAYERS = 1000

MIN_STAGE_MEMORY = 1 << 30
"""Bytes of memory that composing any stage may use."""

TIMEOUT_S = 300.0
"""Seconds that reading a file may take."""


def open_stage(content: FileContent) -> tuple[Any, int]:
    """Open the stage of a file; return it and the size in bytes of the other layers.

    Raise ReadError if it includes a file outside its folder, or too much.
    """
    from pxr import Usd

    layers, other_size = _load_layers(content)
    _check_sublayers(content, layers)
    _check_growth(content, layers[0])
    return Usd.Stage.Open(layers[0]), other_size


def _load_layers(content: FileContent) -> tuple[list[Any], int]:
    """Load the layer of a file and all it includes; return them and the size of the others.

    Missing layers are removed with a warning, since the library would search elsewhere for them.
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
            # Like the library, resolve ".." in the text, regardless of links.
            target = os.path.normpath(Path(path).parent / plain)
            file = find_sibling(content, target)
            if file.is_file() and file.suffix.lower() in SUFFIXES:
                waiting.append(target)
            else:
                layer.UpdateCompositionAssetDependency(name, "")
                content.warn(f"the layer {name!r:.60} is missing or not USD, so it is left out")
    return list(layers.values()), size - len(content.data)


def _check_sublayers(content: FileContent, layers: list[Any]) -> None:
    """Raise ReadError if nested sublayers combine too many layers."""
    from pxr import Sdf

    for layer in layers:
        stack = [layer]
        # The list grows during the loop.
        for sublayer in stack:
            stack += [
                Sdf.Layer.FindRelativeToLayer(sublayer, name) for name in sublayer.subLayerPaths
            ]
            if len(stack) > MAX_SUBLAYERS:
                raise content.error(f"its sublayers expand to more than {MAX_SUBLAYERS}")


def _check_growth(content: FileContent, layer: Any) -> None:
    """Raise ReadError if references include too much, or values are in clips (other files)."""
    from pxr import Pcp, Sdf

    cache = Pcp.Cache(Pcp.LayerStackIdentifier(layer), "usd", True)
    waiting, n_included = [Sdf.Path.absoluteRootPath], 0
    while waiting:
        path = waiting.pop()
        if path.IsPrimPath():
            cache.RequestPayloads([path], [])
        index, _ = cache.ComputePrimIndex(path)
        if any(spec.HasInfo("clips") for spec in index.primStack):
            raise content.error("has its animation in value clips: flatten the stage first")
        nodes = list(index.rootNode.children)  # one per target of a reference
        while nodes:
            nodes += nodes.pop().children
            n_included += 1
            if n_included > MAX_REFERENCES:
                raise content.error(
                    f"its references expand to more than {MAX_REFERENCES} prims: export the "
                    "character by itself"
                )
        waiting += [path.AppendChild(name) for name in index.ComputePrimChildNames()[0]]


def _limit_process(size: int) -> None:
    """Limit this process to the memory that layers of this size may use."""
    if sys.platform == "win32":
        return
    import resource

    memory = MIN_STAGE_MEMORY + MAX_EXPANSION * size
    # A limit of 0 for core files: none is written if the process crashes.
    for limit, most in ((resource.RLIMIT_DATA, memory), (resource.RLIMIT_CORE, 0)):
        soft, hard = resource.getrlimit(limit)
        wanted = most if soft == resource.RLIM_INFINITY else min(most, soft)
        with suppress(OSError, ValueError):  # some systems do not allow this limit
            resource.setrlimit(limit, (wanted, hard))
