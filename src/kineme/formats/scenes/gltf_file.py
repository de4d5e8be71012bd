"""Parse a glTF 2.0 file: its JSON, and the arrays in its buffers.

A GLB has a header and two chunks, JSON and bytes. A ``.gltf`` is only the JSON, with buffers in
base64 or in files next to it. An accessor is an array in a view of a buffer: its type is the number
of components per element, its component type their number format.

Source: Khronos Group, "glTF 2.0 specification", sections 3.6 and 4.
"""

from __future__ import annotations

import base64
import binascii
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import unquote

import numpy as np
from msgspec import Struct, field
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.json import decode_json
from kineme.formats.files import FileContent, find_sibling, load

Part = TypeVar("Part")

MAGIC = b"glTF"
JSON, BYTES = 0x4E4F534A, 0x004E4942
"""Types of chunks."""

COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""NumPy types by ``componentType`` of an accessor."""

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
"""Components per element by ``type`` of an accessor."""

HEADER, CHUNK = struct.Struct("<4sII"), struct.Struct("<II")


class Asset(Struct):
    """Metadata of the file."""

    version: Any = "1.0"
    """A text since glTF 2.0."""
    extras: Any = None


class Head(Struct):
    """Part of the JSON that all versions share."""

    asset: Asset


class Buffer(Struct):
    """Bytes in the GLB, in the JSON, or in a file next to it."""

    uri: str | None = None


class BufferView(Struct, rename="camel"):
    """A span of a buffer."""

    buffer: int
    byte_length: int
    byte_offset: int = 0
    byte_stride: int | None = None
    extensions: dict[str, Any] = field(default_factory=dict)


class ViewPart(Struct, rename="camel"):
    """A part of a buffer view, from an offset on."""

    buffer_view: int
    byte_offset: int = 0
    component_type: int = 5125


class Sparse(Struct):
    """Elements of an accessor that have other values."""

    count: int
    indices: ViewPart
    values: ViewPart


class Accessor(Struct, rename="camel"):
    """An array in a buffer view, or zeros without one."""

    component_type: int
    count: int
    type: str
    buffer_view: int | None = None
    byte_offset: int = 0
    normalized: bool = False
    sparse: Sparse | None = None


class SceneObject(Struct):
    """A node of the scene."""

    name: str = ""
    children: list[int] = field(default_factory=list)
    matrix: list[float] | None = None
    translation: list[float] | None = None
    rotation: list[float] | None = None
    scale: list[float] | None = None
    mesh: int | None = None
    camera: int | None = None
    extras: Any = None


class Skin(Struct, rename="camel"):
    """Joints that deform a mesh, and the accessor of their inverse bind matrices."""

    joints: list[int]
    inverse_bind_matrices: int | None = None
    skeleton: int | None = None


class KeySampler(Struct):
    """Times and values of keys, as numbers of accessors."""

    input: int
    output: int
    interpolation: str = "LINEAR"


class Target(Struct):
    """Property of a node that a channel animates."""

    path: str
    node: int | None = None


class Channel(Struct):
    """A sampler and its target."""

    sampler: int
    target: Target


class Animation(Struct):
    """Channels that play together."""

    channels: list[Channel]
    samplers: list[KeySampler]
    name: str = ""


class Tree(Struct, rename="camel"):
    """Parts of the JSON that kineme reads."""

    asset: Asset
    buffers: list[Buffer] = field(default_factory=list)
    buffer_views: list[BufferView] = field(default_factory=list)
    accessors: list[Accessor] = field(default_factory=list)
    nodes: list[SceneObject] = field(default_factory=list)
    skins: list[Skin] = field(default_factory=list)
    animations: list[Animation] = field(default_factory=list)


class GLTFFile:
    """JSON and buffers of a glTF file."""

    def __init__(self, content: FileContent) -> None:
        self.content = content
        text, self._chunk = content.data, b""
        if text.startswith(MAGIC):
            text, self._chunk = _split_chunks(content)
        version = str(decode_json(text, content.path, Head).asset.version)
        if not version.startswith("2"):
            raise content.error(f"is glTF of version {version:.20}: export glTF 2.0")
        self.text = text
        """JSON of the file, as text."""
        self.tree = decode_json(text, content.path, Tree)
        self.external_size = 0
        """Size in bytes of buffers in other files."""
        self._buffers: dict[int, bytes] = {}

    def get_part(self, parts: Sequence[Part], number: int | None, what: str) -> Part:
        """Return an item of a list in the JSON; raise ReadError if there is none of this number."""
        if number is None or not 0 <= number < len(parts):
            raise self.content.error(f"{what} {number} is not in the file: damaged")
        return parts[number]

    def read_array(self, number: int) -> Floats:
        """Return the values of an accessor (elements, components)."""
        accessor = self.get_part(self.tree.accessors, number, "accessor")
        code, width = COMPONENTS.get(accessor.component_type), WIDTHS.get(accessor.type)
        if code is None or width is None:
            raise self.content.error(f"accessor {number} has a type that is not in glTF")
        if accessor.count < 1:
            raise self.content.error(f"accessor {number} has no elements: damaged")
        if accessor.buffer_view is None:
            size = 8 * accessor.count * width
            self.content.require_memory(size, f"an accessor of {accessor.count}")
            stored = np.zeros((accessor.count, width), code)
        else:
            part = ViewPart(accessor.buffer_view, accessor.byte_offset)
            stored = self._read_elements(number, part, (accessor.count, width), code)
        if (sparse := accessor.sparse) is not None:
            # The array is a read-only view of the file's bytes.
            stored = stored.copy()
            kind = COMPONENTS.get(sparse.indices.component_type, "<f4")
            rows = self._read_elements(number, sparse.indices, (sparse.count, 1), kind)[:, 0]
            if rows.dtype.kind != "u" or rows.max() >= accessor.count:
                raise self.content.error(f"accessor {number} has values outside of it: damaged")
            replacements = self._read_elements(number, sparse.values, (sparse.count, width), code)
            stored[rows] = replacements
        values = stored.astype(np.float64)
        if accessor.normalized and stored.dtype.kind in "iu":
            # The largest integer is 1, the smallest is clipped to -1 (section 3.6.2.2).
            values = np.maximum(values / np.iinfo(stored.dtype).max, -1.0)
        if not np.isfinite(values).all():
            raise self.content.error(f"accessor {number} has values that are not finite: damaged")
        return values

    def _read_elements(
        self, number: int, part: ViewPart, shape: tuple[int, int], code: str
    ) -> NDArray[Any]:
        """Return the elements of an accessor in a buffer view."""
        view = self.get_part(self.tree.buffer_views, part.buffer_view, "buffer view")
        if "EXT_meshopt_compression" in view.extensions:
            reason = "its keys are compressed by meshopt: export it without compression"
            raise self.content.error(reason)
        data = self.read_buffer(view.buffer)
        size, (count, width) = np.dtype(code).itemsize, shape
        # Without a stride the elements are contiguous.
        step = view.byte_stride or size * width
        start = view.byte_offset + part.byte_offset
        stop = min(view.byte_offset + view.byte_length, len(data))
        if min(view.byte_offset, part.byte_offset) < 0 or count < 1 or step < size:
            raise self.content.error(f"accessor {number} is outside its buffer: damaged")
        # The last element needs no whole stride.
        if start + (count - 1) * step + size * width > stop:
            raise self.content.error(f"accessor {number} is longer than its buffer: truncated")
        # A strided view reads interleaved attributes without a copy.
        return np.ndarray(shape, code, data, start, (step, size))

    def read_buffer(self, number: int) -> bytes:
        """Return the bytes of a buffer."""
        if number not in self._buffers:
            uri = self.get_part(self.tree.buffers, number, "buffer").uri
            self._buffers[number] = self._chunk if uri is None else self.read_uri(uri)
        return self._buffers[number]

    def read_uri(self, uri: str) -> bytes:
        """Return the bytes of a buffer in the JSON, or in a file next to it."""
        if uri.startswith("data:"):
            try:
                return base64.b64decode(uri.partition(",")[2], validate=True)
            except (binascii.Error, ValueError):
                raise self.content.error("a buffer is not base64: damaged") from None
        name = unquote(uri)
        # Read only files in the folder of the glTF or below.
        if Path(name).is_absolute() or ".." in Path(name).parts or ":" in name:
            raise self.content.error(f"has a buffer in {name!r:.60}: put that file next to it")
        data = load(find_sibling(self.content, name)).data
        self.external_size += len(data)
        return data


def _split_chunks(content: FileContent) -> tuple[bytes, bytes]:
    """Return the JSON and the bytes of a GLB."""
    data = content.data
    if len(data) < HEADER.size:
        raise content.error("the file ends in its header: it is truncated")
    _, version, length = HEADER.unpack_from(data)
    if version != 2:
        raise content.error(f"is a GLB of version {version}: export glTF 2.0")
    if length > len(data):
        raise content.error(f"has {len(data)} bytes instead of {length}: it is truncated")
    chunks: dict[int, bytes] = {}
    offset = HEADER.size
    while offset + CHUNK.size <= length:
        size, kind = CHUNK.unpack_from(data, offset)
        offset += CHUNK.size
        chunks.setdefault(kind, data[offset : offset + size])
        offset += size
    if JSON not in chunks:
        raise content.error("has no JSON in it: damaged")
    return chunks[JSON], chunks.get(BYTES, b"")
