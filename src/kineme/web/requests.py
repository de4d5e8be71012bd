"""What the pages send: edits of a table, and what to make of it or compare it with.

Fields are checked as those of edits are (`kineme.web.edits`).
"""

from __future__ import annotations

from msgspec import UNSET, UnsetType

from kineme.web.edits import Edit, Integer, Number, Request, Text


class EditRequest(Request, frozen=True, kw_only=True):
    """An edit of the table as it was at ``revision``.

    ``name`` is the edit's own: one that is sent again, for want of an answer, is made once.
    """

    revision: Integer
    edit: Edit
    name: Text | UnsetType = UNSET


class PreviewRequest(Request, frozen=True, kw_only=True):
    """A segmentation to look at, as ``SegmentAgain`` would make it."""

    preset: Text
    parameters: dict[Text, Number]
    keep: bool
    detail: Number | UnsetType = UNSET


class LabelsRequest(Request, frozen=True, kw_only=True):
    """The labels that all recordings of the folder share, those on the keys 1 to 9 first."""

    labels: list[Text]


class KnowledgeRequest(Request, frozen=True, kw_only=True):
    """A knowledge base of that name, of the named primitives of recordings."""

    name: Text
    recordings: list[Text]


class ClipsRequest(Request, frozen=True, kw_only=True):
    """Segments by their rows in the table, as motion files; with ``loops`` made to close."""

    rows: list[Integer]
    loops: bool


class VideoRequest(Request, frozen=True, kw_only=True):
    """Where the recording starts in its reference video, seconds."""

    offset_s: Number


class ReadingRequest(Request, frozen=True, kw_only=True):
    """How a recording is read; empty: as the file says."""

    person: Text = ""
    fps: Number = 0
    unit: Text = ""
    up: Text = ""


class CompareRequest(Request, frozen=True, kw_only=True):
    """Another result to lay beside the shown one: a preset's, or a file's of the folder."""

    preset: Text | UnsetType = UNSET
    annotation: Text | UnsetType = UNSET
