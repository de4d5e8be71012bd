"""Write a report: one HTML page with everything in it, for any browser, without a network.

The page is built from the sources in ``web/pages`` and comes with the package. It has placeholders
for data, which become script elements that browsers do not run: the `kineme.web.messages.Recording`
message, the binary motion, the tiles of the similarity matrix, and the curves of repetitions. Only
a video stays outside: the page plays it from its own file.
"""

from __future__ import annotations

import json
import os
import zlib
from base64 import b64encode
from importlib.resources import files
from os import PathLike
from pathlib import Path
from urllib.parse import quote

from msgspec import structs

from kineme._util.checks import check_path, check_type
from kineme._util.files import PAGES, atomic_write
from kineme.errors import WriteError
from kineme.features import Names
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.web.curves import as_recording, make_report_curves
from kineme.web.cycle_curves import CycleCurves
from kineme.web.display import describe_video, draw_picture
from kineme.web.encoding import to_json
from kineme.web.matrix import make_report_tiles
from kineme.web.messages import Recording, ReportCurves
from kineme.web.page_data import PageData, Shown, make_page_data, make_recording_message


def write_report(
    recording: Shown,
    segmentation: Segmentation,
    path: str | PathLike[str],
    *,
    name: str | None = None,
    effectors: Names | None = None,
) -> None:
    """Write a page that shows a recording and its segments.

    A video of the recording is played from its own file, so keep page and video together.

    Parameters
    ----------
    recording : Motion, Signals or array_like
        The segmented recording; arrays are (frames, channels).
    segmentation : Segmentation
        Its segments, by any method or from a table.
    path : str or PathLike
        The page, .html.
    name : str, optional
        What the page calls the recording; by default the name of its file.
    effectors : mapping, optional
        Joints to use as head, hands and feet if their names are unknown.

    Raises
    ------
    ParameterError
        The length or frame rate of the segments differs from that of the recording.
    WriteError
        The suffix is not .html or .htm, or the file cannot be written.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording
    >>> motion = kineme.read(bundled_recording())
    >>> kineme.write_report(motion, kineme.segment(motion), "report.html")
    """
    check_type(segmentation, Segmentation, "write_report", "kineme.segment(motion) gives one")
    check_path(path, "write_report")
    if name is not None:
        check_type(name, str, "name", "give a text, or leave it out")
    if Path(path).suffix.lower() not in PAGES:
        raise WriteError(path, f"the suffix of a report must be {', '.join(PAGES)}")
    data = make_page_data(recording, fps=segmentation.fps, effectors=effectors)
    tiles = make_report_tiles(data.matrix)
    message = make_recording_message(
        data, segmentation, name=name or _find_name(segmentation), levels=True
    )
    source = as_recording(recording, data.fps)
    message, keypoints = _add_video(message, recording, Path(path))
    others = [segmentation.at_detail(level.detail) for level in message.levels]
    with atomic_write(path) as draft:
        page = fill_template(
            (files("kineme") / "web" / "static" / "report.html").read_text(encoding="utf-8"),
            message,
            data.binary,
            tiles,
            _make_curves(recording, data),
            CycleCurves(lambda: source).make_report(segmentation, others),
            keypoints,
        )
        draft.write_text(page, encoding="utf-8")


def fill_template(
    template: str,
    message: Recording,
    binary: bytes,
    tiles: dict[str, bytes],
    curves: dict[str, object] | None = None,
    cycles: ReportCurves | None = None,
    keypoints: bytes = b"",
) -> str:
    """Return the template with its placeholders replaced by the data.

    ``tiles`` are PNGs by "level/row/column". ``curves`` has ``list`` and ``tiles``, or is None.
    ``cycles`` are the curves of repetitions, ``keypoints`` those drawn over a video.
    """
    pictures = {key: _encode_base64(tile) for key, tile in tiles.items()}
    parts = {
        "recording": ("application/json", _encode_json(message)),
        "motion": ("application/octet-stream;base64", _encode_base64(binary)),
        "tiles": ("application/json", _encode_json(pictures)),
        "curves": ("application/json", _encode_json(curves)),
        "keypoints": ("application/octet-stream;base64", _encode_base64(keypoints)),
        "cycles": (
            "application/json;deflate;base64",
            _encode_base64(zlib.compress(to_json(cycles))),
        ),
    }
    for part, (kind, text) in parts.items():
        element = f'<script type="{kind}" id="kineme-{part}">{text}</script>'
        template = template.replace(f"<!--kineme:{part}-->", element)
    return template


def _add_video(message: Recording, recording: Shown, page: Path) -> tuple[Recording, bytes]:
    """Return the message with the video of the recording, and the keypoints drawn over it."""
    if not isinstance(recording, Motion | Signals) or recording.provenance.path is None:
        return message, b""
    source = Path(recording.provenance.path)
    person = recording.provenance.person
    picture = draw_picture(source, person) if isinstance(recording, Motion) else None
    video = describe_video(source, picture)
    if video is None:
        return message, b""
    video_path = source.with_name(video.name)
    try:
        address = quote(os.path.relpath(video_path, page.parent).replace(os.sep, "/"))
    except ValueError:  # on another Windows drive
        address = video_path.absolute().as_uri()
    video = structs.replace(video, address=address)
    return structs.replace(message, video=video), picture.binary if picture else b""


def _make_curves(recording: Shown, data: PageData) -> dict[str, object] | None:
    """Return the channels of a recording without poses; None for a motion."""
    if data.motion is not None:
        return None
    head, curves = make_report_curves(recording, data.fps)
    return {"list": head, "tiles": {place: _encode_base64(data) for place, data in curves.items()}}


def _find_name(segmentation: Segmentation) -> str:
    """Return the file name in the provenance, which may hold anything in foreign tables."""
    source = segmentation.provenance.get("input")
    path = source.get("path") if isinstance(source, dict) else None
    return Path(str(path or "recording")).name


def _encode_json(value: object) -> str:
    """Return JSON that cannot close or extend its script element."""
    text = json.dumps(json.loads(to_json(value)), separators=(",", ":"))  # ASCII only
    # Escape the characters that begin tags and entities.
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _encode_base64(data: bytes) -> str:
    return b64encode(data).decode("ascii")
