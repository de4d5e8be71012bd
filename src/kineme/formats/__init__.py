"""Reading and writing recordings.

`read` picks a reader by what the file holds and by its suffix; `write` picks a
writer by suffix. Every reader gives a `Motion` in metres, y up, and says in
its provenance what the file did not tell and had to be inferred. One module
per format; `register` adds more.
"""

from kineme.formats.arrays import arrays, mat
from kineme.formats.keypoints import pose_json, sleap
from kineme.formats.markers import c3d, mot, trc
from kineme.formats.registry import (
    Format,
    ReadOptions,
    read,
    register,
    supported_formats,
    write,
)
from kineme.formats.skeletons import amc, bvh
from kineme.formats.tables import tables

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
