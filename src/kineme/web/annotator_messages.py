"""Messages about the labels of several people."""

from __future__ import annotations

from msgspec import Struct

from kineme.web.messages import Segments
from kineme.web.requests import Request, Text


class AnnotatorChoice(Struct, frozen=True, kw_only=True):
    """A person who labelled this number of recordings of the folder."""

    id: str
    name: str
    recordings: int


class AgreementRequest(Request, frozen=True, kw_only=True):
    """Ids of the people to compare."""

    annotators: list[Text]


class AgreementPair(Struct, frozen=True, kw_only=True):
    """Agreement of two people on the recordings that both labelled."""

    annotators: tuple[str, str]
    cohen_kappa: float | None
    border_f1: float | None
    recordings: int


class Difference(Struct, frozen=True, kw_only=True):
    """A span in seconds where labels differ, and the label of each person; empty if unlabelled."""

    start_s: float
    stop_s: float
    labels: tuple[str, ...]


class RecordingAgreement(Struct, frozen=True, kw_only=True):
    """Agreement of the people who labelled a recording, and where they differ."""

    id: str
    name: str
    annotators: list[str]
    fleiss_kappa: float | None
    differences: list[Difference]


class Agreement(Struct, frozen=True, kw_only=True):
    """Agreement of people over the folder.

    With ``by_names`` labels are compared by name, else by the best mapping between people.
    ``failures`` are sentences about labels that could not be read.
    """

    annotators: list[str]
    by_names: bool
    fleiss_kappa: float | None
    pairs: list[AgreementPair]
    recordings: list[RecordingAgreement]
    failures: list[str]


class LabelLane(Struct, frozen=True, kw_only=True):
    """Labels of one person for the open recording."""

    name: str
    segmentation: Segments
