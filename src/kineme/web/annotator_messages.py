"""What the pages and the server tell each other of several people's labels."""

from __future__ import annotations

from msgspec import Struct

from kineme.web.messages import Segments
from kineme.web.requests import Request, Text


class AnnotatorChoice(Struct, frozen=True, kw_only=True):
    """Somebody who labelled so many recordings of the folder."""

    id: str
    name: str
    recordings: int


class AgreementRequest(Request, frozen=True, kw_only=True):
    """Who is to be compared, by their ids."""

    annotators: list[Text]


class AgreementPair(Struct, frozen=True, kw_only=True):
    """How far two people agree, on the recordings that both labelled."""

    annotators: tuple[str, str]
    cohen_kappa: float | None
    border_f1: float | None
    recordings: int


class Difference(Struct, frozen=True, kw_only=True):
    """A span in seconds in which not all say the same, and what each says; empty is nothing."""

    start_s: float
    stop_s: float
    labels: tuple[str, ...]


class RecordingAgreement(Struct, frozen=True, kw_only=True):
    """How far those agree who labelled a recording, and where they differ."""

    id: str
    name: str
    annotators: list[str]
    fleiss_kappa: float | None
    differences: list[Difference]


class Agreement(Struct, frozen=True, kw_only=True):
    """How far people agree over the folder.

    With ``by_names`` classes are names; else those of one stand for those of another by the best
    mapping. ``failures`` are sentences on labels that could not be read.
    """

    annotators: list[str]
    by_names: bool
    fleiss_kappa: float | None
    pairs: list[AgreementPair]
    recordings: list[RecordingAgreement]
    failures: list[str]


class LabelLane(Struct, frozen=True, kw_only=True):
    """What somebody says of the open recording."""

    name: str
    segmentation: Segments
