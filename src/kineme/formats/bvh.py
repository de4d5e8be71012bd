"""BVH."""
from kineme.formats.registry import Format
FORMAT = Format("BVH", (".bvh",), lambda head: b"HIERARCHY" in head)
