"""The constants of a vocabulary, which go into the head of a library."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from kineme.methods.constants import (
    SHARE,
    SOME,
    SOME_LENGTH,
    SOME_TIME,
    check,
    constant,
    constants_of,
)


@dataclass(frozen=True, kw_only=True)
class VocabularyConstants:
    """How the clusters of single recordings are joined; distances are those of a search."""

    join: float = constant(
        "words are joined up to this mean distance, that of a search", limits=SOME_LENGTH,
        default=0.85,
    )  # fmt: skip
    farthest: float = constant(
        "no two words are farther apart", limits=SOME_LENGTH, default=2.0, fine=True
    )
    told_apart: float = constant(
        "those of one recording are as far apart at least", limits=SOME_LENGTH, default=1.3,
        fine=True,
    )  # fmt: skip
    longest_example: float = constant(
        "an example is cut to this", unit="s", limits=SOME_TIME, default=4.0, fine=True
    )
    longest_context: float = constant(
        "and what it is looked for in to this", unit="s", limits=SOME_TIME, default=12.0, fine=True
    )
    most: int = constant(
        "words compared each with each; of more a sample is", limits=SOME, default=400, fine=True
    )
    typical: int = constant(
        "words of each cluster that the others are compared with", limits=SOME, default=5, fine=True
    )
    nearest: int = constant(
        "clusters whose embeddings are nearest, of which a word may be", limits=SOME, default=4,
        fine=True,
    )  # fmt: skip
    unsure: float = constant(
        "confidence below which a word is shown as unsure", limits=SHARE, default=0.1,
        fine=True,
    )  # fmt: skip

    def __post_init__(self) -> None:
        check(self)

    def parameters(self) -> Mapping[str, Any]:
        """The value of each constant by name, for the head of a library."""
        return {known.name: known.value for known in constants_of(self)}


VOCABULARY = VocabularyConstants()
