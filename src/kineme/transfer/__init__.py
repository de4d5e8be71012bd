"""Label transfer: what a knowledge base calls its primitives, others like them are called.

Source: Vögele, Krüger and Klein 2014, section 6.1.
"""

from kineme.transfer.knowledge import KnowledgeBase, transfer_features
from kineme.transfer.labels import THRESHOLD, name_primitives, transfer_labels

__all__ = [
    "THRESHOLD",
    "KnowledgeBase",
    "name_primitives",
    "transfer_features",
    "transfer_labels",
]
