"""A walking set of markers, and C3D files of it written byte by byte."""

from __future__ import annotations

from typing import Any

import numpy as np

INTEL, DEC, MIPS = 84, 85, 86
_AT = {
    "LASI": (0.1, 1.0, 0.1),
    "RASI": (-0.1, 1.0, 0.1),
    "LPSI": (0.05, 1, -0.1),
    "RPSI": (-0.05, 1, -0.1),
    "LANK": (0.1, 0.1, 0),
    "RANK": (-0.1, 0.1, 0),
    "LFHD": (0.07, 1.65, 0.1),
    "RFHD": (-0.07, 1.65, 0.1),
    "LBHD": (0.07, 1.65, -0.1),
    "RBHD": (-0.07, 1.65, -0.1),
    "LWRA": (0.3, 0.9, 0.05),
    "LWRB": (0.3, 0.9, -0.05),
    "RWRA": (-0.3, 0.9, 0.05),
    "RWRB": (-0.3, 0.9, -0.05),
    "C7": (0, 1.5, -0.1),
    "T10": (0, 1.3, -0.1),
    "STRN": (0, 1.3, 0.1),
    "LKNE": (0.1, 0.5, 0.05),
}
PLUG_IN_GAIT = [*_AT]


def make_walk(frames: int = 60, fps: float = 100.0) -> np.ndarray:
    """(frames, markers of `PLUG_IN_GAIT`, 3): metres, y up, facing z, moving ahead."""
    t = np.arange(frames)[:, None] / fps
    points = np.repeat(np.array([*_AT.values()])[None], frames, axis=0)
    phase = np.array([(-1) ** name.startswith("R") for name in PLUG_IN_GAIT])
    swing = np.array([0.3 * (name[1:] in ("ANK", "WRA", "WRB")) for name in PLUG_IN_GAIT])
    points[:, :, 2] += t + swing * phase * np.sin(2 * np.pi * t)
    return points


def to_millimetres(points: np.ndarray) -> np.ndarray:
    """As most laboratories store them."""
    return 1000 * points[:, :, [0, 2, 1]] * [1, -1, 1]


def to_c3d(
    points: np.ndarray,
    labels: list[str],
    *,
    processor: int = INTEL,
    real: bool = True,
    scale: float = 0.1,
    rate: float = 100.0,
    first: int = 1,
    unit: str | None = "mm",
    y_screen: str | None = "+Z",
    analog: np.ndarray | None = None,
    more: dict[tuple[str, str], Any] | None = None,
) -> bytes:
    """A C3D file; NaN positions get a residual of -1.

    ``analog`` is (frames, samples in a frame, channels); ``more`` are parameters
    by group and name: floats, lists of strings, or arrays.
    """
    frames, n, _ = points.shape
    blocks = [labels[i : i + 255] for i in range(0, n, 255)]
    values: dict[tuple[str, str], Any] = {
        ("POINT", "USED"): np.int16([n]),
        ("POINT", "SCALE"): np.float32([-scale if real else scale]),
        ("POINT", "RATE"): np.float32([rate]),
        ("POINT", "FRAMES"): np.uint16([min(frames, 65535)]).view(np.int16),
        **{("POINT", f"LABELS{i + 1}" if i else "LABELS"): b for i, b in enumerate(blocks)},
    }
    if unit is not None:
        values["POINT", "UNITS"] = [unit]
    if y_screen is not None:
        values["POINT", "X_SCREEN"] = ["+X"]
        values["POINT", "Y_SCREEN"] = [y_screen]
    channels = samples = 0
    if analog is not None:
        _, samples, channels = analog.shape
        values["ANALOG", "USED"] = np.int16([channels])
        values["ANALOG", "LABELS"] = [f"emg{i}" for i in range(channels)]
    parameters = _to_records(values | (more or {}), processor)
    n_blocks = -(-len(parameters) // 512)
    block = 2 + n_blocks
    head = bytearray(512)
    head[:2] = b"\x02\x50"
    last = first + frames - 1
    counts = (n, samples * channels, min(first, 65535), min(last, 65535), 0)
    head[2:12] = _to_words(np.array(counts, np.uint16).view(np.int16), processor)
    head[12:16] = _to_words(np.float32([-scale if real else scale]), processor)
    head[16:20] = _to_words(np.array([block, samples], np.int16), processor)
    head[20:24] = _to_words(np.float32([rate]), processor)
    quads = np.zeros((frames, n, 4))
    quads[:, :, :3] = points if real else points / scale
    quads[np.isnan(points).any(axis=2)] = (0, 0, 0, -1)
    rows = quads.reshape(frames, -1)
    if analog is not None:
        rows = np.concatenate([rows, analog.reshape(frames, -1)], axis=1)
    stored = rows.astype(np.float32) if real else np.rint(rows).astype(np.int16)
    return bytes(head) + parameters.ljust(512 * n_blocks, b"\0") + _to_words(stored, processor)


def _to_records(values: dict[tuple[str, str], Any], processor: int) -> bytes:
    groups = sorted({group for group, _ in values})
    out = bytearray([1, 0x50, 0, processor])
    for i, group in enumerate(groups, 1):
        out += bytes([len(group), 256 - i]) + group.encode()
        out += _to_words(np.int16([3]), processor) + b"\0"
    for (group, name), value in values.items():
        if isinstance(value, list):
            width = max(map(len, value), default=1)
            data = "".join(text.ljust(width) for text in value).encode()
            body = bytes([255, 2, width, len(value)]) + data
        else:
            array = np.asarray(value)
            shape = array.shape[::-1]  # the first dimension runs fastest
            body = bytes([4 if array.dtype.kind == "f" else 2, len(shape), *shape])
            body += _to_words(array, processor)
        body += b"\0"
        out += bytes([len(name), groups.index(group) + 1]) + name.encode()
        out += _to_words(np.int16([len(body) + 2]), processor) + body
    return bytes(out + b"\0\0")


def _to_words(array: np.ndarray, processor: int) -> bytes:
    if array.dtype.kind == "f" and processor == DEC:
        pairs = (array.astype(np.float32) * 4).view("<u2").reshape(-1, 2)
        return pairs[:, ::-1].tobytes()
    kind = "f4" if array.dtype.kind == "f" else "i2"
    return array.astype((">" if processor == MIPS else "<") + kind).tobytes()
