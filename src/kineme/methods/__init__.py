"""Segmentation methods on plain arrays (samples × dims), one folder each, and their presets."""
