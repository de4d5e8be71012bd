"""Reading and writing recordings.

`read` picks a reader by what the file holds and by its suffix; `write` picks a
writer by suffix. Every reader gives a `Motion` in metres, y up, and says in
its provenance what the file did not tell and had to be inferred. One module
per format; `register` adds more.
"""

from kineme.formats import amc, arrays, bvh, c3d, mat, mot, pose_json, sleap, tables, trc
from kineme.formats.registry import (
    Format,
    ReadOptions,
    read,
    register,
    supported_formats,
    write,
)

register(amc.SKELETON)
register(amc.FORMAT)
register(bvh.FORMAT)
register(c3d.FORMAT)
register(trc.FORMAT)
register(mot.FORMAT)
register(tables.FORMAT)
register(tables.PARQUET)
register(arrays.NPZ)
register(arrays.NPY)
register(mat.FORMAT)
register(sleap.FORMAT)
register(pose_json.MEDIAPIPE)
register(pose_json.COCO)
register(pose_json.OPENPOSE)

__all__ = ["Format", "ReadOptions", "read", "register", "supported_formats", "write"]
