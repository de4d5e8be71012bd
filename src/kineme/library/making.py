"""From a recording to its piece: segmented and described."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.library.descriptions import describe
from kineme.library.settings import Settings
from kineme.library.storage.layout import EMBEDDED
from kineme.library.storage.pieces import LARGEST_MOMENT, Piece
from kineme.recordings import Motion, Signals
from kineme.segmentation.segmenter import segment
from kineme.transfer.channel_samples import channel_samples


def make_piece(
    recording: Motion | Signals, settings: Settings
) -> tuple[Piece, NDArray[np.float32], NDArray[np.float32] | None]:
    """What is kept of a recording, its features, and its moments.

    Parameters
    ----------
    recording : Motion or Signals
    settings : Settings

    Returns
    -------
    piece : Piece
    features : (samples, dims) array
    moments : (moments, 1 + 2 · channels) array, or None
        Of signals: the second of each, means and deviations.
    """
    emg = settings.options().emg
    found = segment(
        recording,
        preset=settings.preset,
        effectors=settings.effectors,
        emg=emg,
        **settings.constants,
    ).level(settings.detail)
    described = describe(recording, effectors=settings.effectors, emg=emg)
    embeddings = np.zeros((len(found.table), EMBEDDED), np.float32)
    for row, each in enumerate(found.table):
        if each.kind != "transition":
            embeddings[row] = described.embedding(each.start_s, each.stop_s)
    moments = _moments(recording) if isinstance(recording, Signals) else None
    reason = f"not searched: {described.reason}" if described.reason else ""
    facts = {
        "format": recording.provenance.format or "",
        "n_frames": recording.n_frames,
        "fps": recording.fps,
        "vocabulary": described.vocabulary,
        "features_fps": described.fps,
        "samples": len(described.features),
        "moments": 0 if moments is None else len(moments),
        "notes": [*found.provenance["notes"], *filter(None, [reason])],
    }
    return Piece(facts, found.table, embeddings), described.features, moments


def _moments(signals: Signals) -> NDArray[np.float32]:
    found = channel_samples(signals)
    columns = np.column_stack([found.frames / signals.fps, found.means, found.deviations])
    held: NDArray[np.float32] = np.clip(columns, -LARGEST_MOMENT, LARGEST_MOMENT).astype(np.float32)
    return held
