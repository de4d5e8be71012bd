"""Formats of pose estimates: OpenPose, COCO, MediaPipe, SLEAP, DeepLabCut and others."""
