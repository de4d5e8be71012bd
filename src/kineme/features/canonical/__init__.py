"""Features of a canonical body, in which movements of different people match."""

from kineme.features.canonical.body import mirror_poses
from kineme.features.canonical.matching import (
    MATCHING_FPS,
    matching_features,
    matching_poses,
    mirror_features,
)
