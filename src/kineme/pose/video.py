"""Read videos as recordings: the first reading estimates the poses of the people in them."""

from __future__ import annotations

from kineme._util.files import VIDEOS
from kineme.formats.files import FileContent
from kineme.formats.keypoints.poses import poses_to_motion, read_poses
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.pose.estimating import keep_poses
from kineme.recordings import Motion

_BOXES = (b"ftyp", b"moov", b"mdat", b"wide", b"free")
_EBML = b"\x1a\x45\xdf\xa3"  # Matroska and WebM


def read_video(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of one person in a video; estimate its poses unless they are there."""
    poses = read_poses(keep_poses(content))
    return poses_to_motion(content, poses, options)


def begins_video(head: bytes) -> bool:
    """Return whether a file starts like MP4, QuickTime, Matroska, WebM or AVI."""
    is_avi = head.startswith(b"RIFF") and head[8:12] == b"AVI "
    return head[4:8] in _BOXES or head.startswith(_EBML) or is_avi


FORMAT = Format("video", VIDEOS, begins_video, read_video, is_video=True)
