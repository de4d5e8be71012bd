"""Formats of skeletons with rotations: ASF/AMC, BVH."""
