"""Label transfer: give segments the labels of similar primitives in a knowledge base.

Source: Vögele, Krüger and Klein 2014, section 6.1.
"""

from kineme.features.canonical import matching_features as transfer_features
from kineme.transfer.knowledge import KnowledgeBase
from kineme.transfer.labels import name_primitives, transfer_labels
from kineme.transfer.matching import THRESHOLD
from kineme.transfer.sharing import share_clusters

__all__ = [
    "THRESHOLD",
    "KnowledgeBase",
    "name_primitives",
    "share_clusters",
    "transfer_features",
    "transfer_labels",
]
