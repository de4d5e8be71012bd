"""The method for sensors: posture and energy of channels, a tree of segments, its best level."""
