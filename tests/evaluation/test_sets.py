"""Clusters of single recordings as one vocabulary; rivals as presets."""

from __future__ import annotations

from _rival_presets import RIVALS
from kineme.methods.base import Preset


def test_rivals_are_presets_that_name_their_package() -> None:
    assert all(isinstance(rival, Preset) and rival.package for rival in RIVALS)
    assert len({rival.name for rival in RIVALS}) == len(RIVALS)
