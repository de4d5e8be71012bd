"""Tables to look at beside the present one: what would take its place, and what it replaced."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import UNSET

from kineme.segments import editing
from kineme.segments.editing.carrying import names_of
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.studio.loading import LoadedRecording
from kineme.studio.storage.journal import Step
from kineme.web.messages import Preview, Version
from kineme.web.requests import PreviewRequest


def preview_of(before: Segmentation, loaded: LoadedRecording, wanted: PreviewRequest) -> Preview:
    """What segmenting again would make of a table."""
    from kineme.web.page_data import segments_message

    detail = DEFAULT_DETAIL if wanted.detail is UNSET else wanted.detail
    found = loaded.segment(wanted.preset, wanted.parameters, detail)
    result = editing.carried(before, found)
    lost = [f"{result.corrections} corrections and {result.names} names"]
    return Preview(
        segmentation=segments_message(result.segmentation if wanted.keep else found),
        corrections=result.corrections,
        names=result.names,
        lost=result.lost if wanted.keep else lost,
        details=list(found.hierarchy.details) if found.hierarchy else [DEFAULT_DETAIL],
        detail=found.hierarchy.detail if found.hierarchy else DEFAULT_DETAIL,
    )


def versions_of(kept: Mapping[int, Step], tables: Mapping[int, Segmentation]) -> list[Version]:
    """Tables that were replaced, by their numbers, in the same order."""
    return [
        Version(
            number=number,
            at=step.at,
            edit=step.edit,
            segments=len(tables[number]),
            corrections=tables[number].annotation.corrections,
            names=names_of(tables[number]),
        )
        for number, step in kept.items()
    ]
