"""Reading and writing recordings.

`read` picks a reader by what the file holds and by its suffix; `write` picks a
writer by suffix. Every reader gives a `Motion` in metres, y up, or `Signals`,
and says in the provenance what the file did not tell and had to be inferred.
One module per format; `register` adds more.
"""

from kineme.formats.arrays import mat, numpy_files
from kineme.formats.channels import opensim
from kineme.formats.files import FileContent
from kineme.formats.keypoints import pose_json, sleap
from kineme.formats.markers import c3d, trc
from kineme.formats.options import ReadOptions
from kineme.formats.read_write import read, read_analog, read_motion, read_quietly, sketch, write
from kineme.formats.registry import Format, register, supported_formats
from kineme.formats.skeletons import amc, bvh
from kineme.formats.tables import parquet, text

for _format in (
    amc.SKELETON,
    amc.FORMAT,
    bvh.FORMAT,
    c3d.FORMAT,
    trc.FORMAT,
    opensim.FORMAT,
    text.TEXT,
    text.FORMAT,
    parquet.FORMAT,
    numpy_files.NPZ,
    numpy_files.NPY,
    mat.FORMAT,
    sleap.FORMAT,
    pose_json.MEDIAPIPE,
    pose_json.COCO,
    pose_json.OPENPOSE,
):
    register(_format)

__all__ = [
    "FileContent",
    "Format",
    "ReadOptions",
    "read",
    "read_analog",
    "read_motion",
    "read_quietly",
    "register",
    "sketch",
    "supported_formats",
    "write",
]
