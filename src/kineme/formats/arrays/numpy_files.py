"""Read npz and npy files, and write motions to npz; convert named arrays to motions.

An npy holds positions (frames, joints, 3) without names, or records with named fields as a table.
An npz holds named arrays, like a MAT file. These are read:

- ``poses`` and ``trans`` of AMASS and other files with SMPL poses, see below;
- ``positions`` (frames, joints, 3) with ``names`` and ``fps``. With ``parents`` they are in metres
  with y up, and may have ``offsets``, ``end_sites``, ``rotations`` (w, x, y, z) and ``gaps``, as
  written by kineme;
- an array (frames, 3) for each joint, named after the joint, and ``fps`` or ``time``;
- an array for each column of a table, see `kineme.formats.points`.

`write_npz` stores all of a motion except its provenance. Pickled objects are rejected, as are
archives that claim to unpack to much more than they hold.

``poses`` (frames, 72, 156 or 165) are rotation vectors of the joints of SMPL, SMPL-H or SMPL-X;
``trans`` (frames, 3) is the position of the body. The 22 joints common to all three are used;
hands, jaw and eyes are left out. No body model is needed: bones have average lengths for a height
of 1.70 m instead of the person's. Positions therefore differ by build, and the pelvis by about 0.2
m in height, which affects no feature.

AMASS has z up and bodies at rest along y. Its files are turned accordingly; ``up`` overrides this.

Source: joint order of N. Mahmood et al., "AMASS", ICCV 2019; bone lengths from the shares of height
in D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed. 2009, figure 4.1.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from collections import Counter
from collections.abc import Mapping, Sequence
from lzma import LZMAError
from pathlib import Path
from tokenize import TokenError
from typing import Any
from warnings import catch_warnings

import numpy as np
from numpy.lib import format as npy_format

from kineme._util import rotations as rot
from kineme._util.arrays import Array, Floats
from kineme._util.checks import make_unique
from kineme._util.files import atomic_write, shorten_error
from kineme.formats.files import FileContent, clean_names
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, columns_to_motion, to_motion
from kineme.formats.registry import Format
from kineme.formats.units import make_up_rotation, to_metres
from kineme.recordings import Motion, Skeleton

Arrays = Mapping[str, Array]

_RATES = ("fps", "framerate", "frame_rate", "FrameRate", "rate")
_MAX_DIMENSIONS = 32
# Errors that numpy raises on damaged headers, which are Python literals.
_HEADER_DAMAGE = (
    ValueError, TypeError, LookupError, AttributeError, SyntaxError, OverflowError, TokenError,
    RecursionError, MemoryError,
)  # fmt: skip
WIDTHS = {72: "SMPL", 156: "SMPL-H", 165: "SMPL-X"}
"""Body models by the number of values per frame."""
# Name, parent, offset in metres in a T-pose: y up, facing z, the left at x.
_JOINTS: tuple[tuple[str, str | None, tuple[float, float, float]], ...] = (
    ("pelvis", None, (0, 0, 0)),
    ("left_hip", "pelvis", (0.09, -0.06, 0)),
    ("right_hip", "pelvis", (-0.09, -0.06, 0)),
    ("spine1", "pelvis", (0, 0.11, -0.02)),
    ("left_knee", "left_hip", (0, -0.417, 0)),
    ("right_knee", "right_hip", (0, -0.417, 0)),
    ("spine2", "spine1", (0, 0.13, 0)),
    ("left_ankle", "left_knee", (0, -0.418, 0)),
    ("right_ankle", "right_knee", (0, -0.418, 0)),
    ("spine3", "spine2", (0, 0.06, 0)),
    ("left_foot", "left_ankle", (0, -0.05, 0.13)),
    ("right_foot", "right_ankle", (0, -0.05, 0.13)),
    ("neck", "spine3", (0, 0.21, 0)),
    ("left_collar", "spine3", (0.07, 0.11, 0)),
    ("right_collar", "spine3", (-0.07, 0.11, 0)),
    ("head", "neck", (0, 0.09, 0.02)),
    ("left_shoulder", "left_collar", (0.12, 0.02, 0)),
    ("right_shoulder", "right_collar", (-0.12, 0.02, 0)),
    ("left_elbow", "left_shoulder", (0.316, 0, 0)),
    ("right_elbow", "right_shoulder", (-0.316, 0, 0)),
    ("left_wrist", "left_elbow", (0.248, 0, 0)),
    ("right_wrist", "right_elbow", (-0.248, 0, 0)),
    ("head_end", "head", (0, 0.18, 0)),
)
_AMASS_RATES = ("mocap_frame_rate", "mocap_framerate", "fps", "frame_rate", "framerate")
_N_TURNING = len(_JOINTS) - 1


def read_npz(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion in an npz archive."""
    return arrays_to_motion(content, "npz", read_arrays(content), options)


def read_npy(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion in an npy array."""
    array = _parse_array(content, content.data, "the array")
    if array.dtype.names:
        columns = {name: array[name] for name in array.dtype.names}
        return columns_to_motion(content, "npy", columns, options)
    return positions_to_motion(content, "npy", {"positions": array}, options)


def write_npz(motion: Motion, path: Path) -> None:
    """Write all of a motion except its provenance to an npz archive."""
    skeleton = motion.skeleton
    arrays: dict[str, Any] = {
        "positions": motion.positions,
        "fps": motion.fps,
        "names": np.array(clean_names(path, skeleton.names, str)),
        "parents": np.array(skeleton.parents),
        "offsets": skeleton.offsets,
        "end_sites": np.array(sorted(skeleton.end_sites), np.int64),
    }
    if motion.rotations is not None:
        arrays["rotations"] = motion.rotations
    if motion.gaps:
        arrays["gaps"] = np.array(motion.gaps, np.int64)
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, **arrays)


def read_arrays(content: FileContent) -> dict[str, Array]:
    """Return the arrays of an npz by name; skip those of objects.

    Raise ReadError if the archive is damaged, or claims to hold much more than it can.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content.data)) as archive:
            infos = archive.infolist()
            size = sum(info.file_size for info in infos)
            content.require_memory(size, f"to unpack to {size / 1e6:.0f} MB")
            arrays = {}
            for info in infos:
                data = archive.read(info)
                is_pickled = b"'descr': '|O'" in data[:256]
                if info.filename.endswith(".npy") and not is_pickled:
                    name = info.filename.removesuffix(".npy")
                    arrays[name] = _parse_array(content, data, name)
    except (zipfile.BadZipFile, zlib.error, LZMAError, OSError, EOFError, ValueError) as error:
        raise content.error(f"is not a complete npz archive: {error}") from error
    except (NotImplementedError, RuntimeError) as error:  # other compressions, passwords
        raise content.error(f"its archive cannot be read: {error}") from error
    return arrays


def _parse_array(content: FileContent, data: bytes, name: str) -> Array:
    """Return the array in the bytes of an npy, as a view of them."""
    file = io.BytesIO(data)
    try:
        is_version_1 = npy_format.read_magic(file) == (1, 0)
        header = (
            npy_format.read_array_header_1_0 if is_version_1 else npy_format.read_array_header_2_0
        )
        with catch_warnings(action="ignore"):  # of headers from Python 2
            shape, fortran, dtype = header(file)
        if dtype.hasobject:
            raise content.error(f"{name} holds pickled objects, which are not read")
        if len(shape) > _MAX_DIMENSIONS:
            raise content.error(f"{name} has {len(shape)} dimensions, more than any recording")
        count = int(np.prod(shape, dtype=object))
        # The header may claim more than the file holds.
        if count < 0 or count * dtype.itemsize > len(data) - file.tell():
            raise content.error(f"{name} claims shape {shape}, more than the file holds")
        if count == 0 or dtype.itemsize == 0:
            return np.empty(0)
        flat = np.frombuffer(data, dtype, count, file.tell())
    except _HEADER_DAMAGE as error:
        raise content.error(f"{name} is not an npy array: {shorten_error(error)}") from error
    return flat.reshape(shape, order="F" if fortran else "C")


def arrays_to_motion(
    content: FileContent, name: str, arrays: Arrays, options: ReadOptions
) -> Motion:
    """Return the motion described by named arrays; ``name`` is the name of the format."""
    if "poses" in arrays:
        return poses_to_motion(content, arrays, options)
    if "positions" in arrays:
        return positions_to_motion(content, name, arrays, options)
    columns = {key: array for key, array in arrays.items() if array.ndim == 1}
    columns |= {key: array[None] for key, array in arrays.items() if array.ndim == 0}
    for joint, track in _find_tracks(arrays).items():
        columns |= {f"{joint}_{axis}": track[:, i] for i, axis in enumerate("xyz")}
    return columns_to_motion(content, name, columns, options)


def find_common_length(arrays: Arrays) -> int:
    """Return the most frequent length of arrays; on a tie the longest."""
    lengths = Counter(map(len, arrays.values()))
    return max(lengths, key=lambda n: (lengths[n], n), default=0)


def _find_tracks(arrays: Arrays) -> Arrays:
    """Return the arrays (frames, 3) whose number of frames is the most frequent."""
    tracks = {key: a for key, a in arrays.items() if a.ndim == 2 and a.shape[1] == 3}
    length = find_common_length(tracks)
    return {key: track for key, track in tracks.items() if len(track) == length}


def positions_to_motion(
    content: FileContent, name: str, arrays: Arrays, options: ReadOptions
) -> Motion:
    """Return the motion described by ``positions`` and the arrays that belong to it."""
    positions = _read_numbers(content, arrays, "positions")
    if positions.ndim != 3 or positions.shape[2] != 3 or 0 in positions.shape:
        raise content.error(f"positions have shape {positions.shape}, not (frames, joints, 3)")
    fps = find_rate(content, arrays, _RATES, options.fps)
    is_from_kineme = "parents" in arrays and "names" in arrays  # in metres, y up
    if is_from_kineme and options.unit in (None, "m", 1) and options.up in (None, "y"):
        return _restore_motion(content, name, arrays, positions, fps)
    default_names = [f"joint{i}" for i in range(positions.shape[1])]
    names = list(map(str, arrays["names"].ravel())) if "names" in arrays else default_names
    if len(names) != len(default_names):
        raise content.error(f"{len(names)} names for {len(default_names)} joints")
    positions = np.where(np.isfinite(positions), positions, np.nan)
    unit = options.unit or ("m" if is_from_kineme else None)
    up = options.up or ("y" if is_from_kineme else None)
    points = Points(names, positions, fps, unit, up, person=options.person)
    return to_motion(points, content.provenance(name, []))


def _restore_motion(
    content: FileContent, name: str, arrays: Arrays, positions: Array, fps: float
) -> Motion:
    """Return a motion written by kineme, unchanged."""
    n = positions.shape[1]
    offsets = _read_numbers(content, arrays, "offsets") if "offsets" in arrays else np.zeros((n, 3))
    parents, ends, gaps = (
        _read_integers(content, arrays, key) for key in ("parents", "end_sites", "gaps")
    )
    names = tuple(make_unique(map(str, arrays["names"].ravel())))
    skeleton = Skeleton(names, tuple(parents), offsets, frozenset(ends))
    rotations = _read_numbers(content, arrays, "rotations") if "rotations" in arrays else None
    # Start and stop alternate.
    spans = tuple(zip(gaps[::2], gaps[1::2], strict=False))
    return Motion(skeleton, positions, fps, rotations, content.provenance(name, []), spans)


def _read_integers(content: FileContent, arrays: Arrays, name: str) -> list[int]:
    """Return the whole numbers in an array, none if it is missing."""
    if name not in arrays:
        return []
    values = _read_numbers(content, arrays, name).ravel()
    if not np.isfinite(values).all() or np.abs(values).max(initial=0) > 2**53:
        raise content.error(f"{name} are not whole numbers")
    return values.astype(int).tolist()


def _read_numbers(content: FileContent, arrays: Arrays, name: str) -> Array:
    if arrays[name].dtype.kind not in "iufb":
        raise content.error(f"{name} hold {arrays[name].dtype}, not numbers")
    return np.asarray(arrays[name], np.float64)


def poses_to_motion(content: FileContent, arrays: Arrays, options: ReadOptions) -> Motion:
    """Return the motion of the body described by ``poses`` and ``trans``."""
    poses = _check_arrays(content, arrays, "poses")
    if poses.shape[1] not in WIDTHS:
        widths = ", ".join(f"{n} ({name})" for n, name in WIDTHS.items())
        raise content.error(f"poses have {poses.shape[1]} values per frame, not {widths}")
    path = np.zeros((len(poses), 3))
    if "trans" in arrays:
        path = _check_arrays(content, arrays, "trans")
    if path.shape != (len(poses), 3):
        raise content.error(f"trans has shape {path.shape}, not ({len(poses)}, 3)")
    vectors = poses[:, : 3 * _N_TURNING].reshape(len(poses), _N_TURNING, 3)
    rotations = np.zeros((len(poses), len(_JOINTS), 4))
    rotations[:, -1] = rot.IDENTITY  # the crown, an end site
    rotations[:, :-1] = rot.from_rotation_vectors(vectors)
    turn = make_up_rotation(options.up or "z")
    # Only the root is turned, since all others are relative to their parents.
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    path = rot.rotate(turn, path * to_metres(options.unit or "m"))
    kind = WIDTHS[poses.shape[1]]
    notes = [f"{kind} poses on a skeleton of average lengths, 1.70 m tall; hands and face left out"]
    if options.up is None:
        notes.append("up axis z, as in AMASS, assumed")
    fps = find_rate(content, arrays, _AMASS_RATES, options.fps)
    provenance = content.provenance("AMASS", notes)
    return Motion.from_rotations(make_smpl_skeleton(), rotations, fps, path, provenance=provenance)


def make_smpl_skeleton() -> Skeleton:
    """Return the joints shared by SMPL, SMPL-H and SMPL-X, at average lengths, and a crown."""
    names = tuple(name for name, _, _ in _JOINTS)
    parents = tuple(-1 if parent is None else names.index(parent) for _, parent, _ in _JOINTS)
    offsets = np.array([offset for _, _, offset in _JOINTS])
    return Skeleton(names, parents, offsets, frozenset({len(names) - 1}))


def _check_arrays(content: FileContent, arrays: Arrays, name: str) -> Floats:
    array = arrays[name]
    if array.dtype.kind not in "iuf" or array.ndim != 2 or len(array) == 0:
        raise content.error(
            f"{name} are {array.dtype} of shape {array.shape}, not (frames, values)"
        )
    values = np.asarray(array, np.float64)
    if not np.isfinite(values).all():
        raise content.error(f"{name} hold values that are not finite (NaN or infinite)")
    return values


def find_rate(
    content: FileContent, arrays: Arrays, names: Sequence[str], requested: float | None
) -> float:
    """Return the requested frame rate, else that under the first of the names that holds one."""
    found = (arrays[name] for name in names if name in arrays)
    rates = (float(each.item()) for each in found if each.size == 1 and each.dtype.kind in "iuf")
    stated = next((rate for rate in rates if np.isfinite(rate) and rate > 0), None)
    return content.choose_rate(requested, stated, f"no {names[0]!r} in it")


FORMATS = (
    Format("npy", (".npy",), lambda head: head.startswith(b"\x93NUMPY"), read_npy),
    Format("npz", (".npz",), lambda head: head.startswith(b"PK\x03\x04"), read_npz, write_npz),
)
