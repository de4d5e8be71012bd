"""Cut recordings of human motion into activities, transitions and primitives."""
