"""The report: one page of HTML with everything in it, for any browser, without a network.

The page itself is built from the sources in ``web/pages`` and comes with the
package. It has three marked places for data, which become script elements that
no browser runs: the :class:`Recording` message, the binary motion, and the
tiles of the similarity matrix.
"""

from __future__ import annotations

import json
from base64 import b64encode
from importlib.resources import files
from os import PathLike
from pathlib import Path

from kineme._checks import check_path, check_type
from kineme._files import atomic_write
from kineme.errors import WriteError
from kineme.features import Names
from kineme.segments.segmentation import Segmentation
from kineme.web.messages import Recording
from kineme.web.recording import Source, footage, recording

SUFFIXES = (".html", ".htm")


def write_report(
    source: Source,
    segmentation: Segmentation,
    path: str | PathLike[str],
    *,
    name: str | None = None,
    effectors: Names | None = None,
) -> None:
    """Write a page that shows a recording and its segments.

    Parameters
    ----------
    source : the motion, the `Signals`, or an array (frames, channels) that was segmented
    segmentation : its segments, by any method or from a table
    path : .html
    name : what the page calls the recording; by default the name of its file
    effectors : joints to take for head, hands and feet where names do not tell

    Raises
    ------
    ParameterError : the segments are of another recording: its length or frame
        rate is another
    WriteError : another suffix, or the file cannot be written
    """
    check_type(segmentation, Segmentation, "write_report", "kineme.segment(motion) gives one")
    check_path(path, "write_report")
    if name is not None:
        check_type(name, str, "name", "give a text, or leave it out")
    if Path(path).suffix.lower() not in SUFFIXES:
        raise WriteError(path, f"reports are written as {', '.join(SUFFIXES)}")
    shown = footage(source, fps=segmentation.fps, effectors=effectors)
    tiles, band = shown.matrix.kept()
    message = recording(shown, segmentation, name=name or _name(segmentation), band=band)
    with atomic_write(path) as draft:
        draft.write_text(filled(_template(), message, shown.binary, tiles), encoding="utf-8")


def filled(template: str, message: Recording, binary: bytes, tiles: dict[str, bytes]) -> str:
    """The template with the data in place of its comments."""
    pictures = {place: _base64(tile) for place, tile in tiles.items()}
    parts = {
        "recording": ("application/json", _json(message)),
        "motion": ("application/octet-stream;base64", _base64(binary)),
        "tiles": ("application/json", _json(pictures)),
    }
    for part, (kind, text) in parts.items():
        element = f'<script type="{kind}" id="kineme-{part}">{text}</script>'
        template = template.replace(f"<!--kineme:{part}-->", element)
    return template


def _name(segmentation: Segmentation) -> str:
    """The file's name, if the provenance tells: tables from elsewhere may hold anything there."""
    source = segmentation.provenance.get("input")
    path = source.get("path") if isinstance(source, dict) else None
    return Path(str(path or "recording")).name


def _json(value: object) -> str:
    """JSON that stays inside its script element, whatever the texts in it hold."""
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _base64(data: bytes) -> str:
    return b64encode(data).decode("ascii")


def _template() -> str:
    return (files("kineme") / "web" / "static" / "report.html").read_text(encoding="utf-8")
