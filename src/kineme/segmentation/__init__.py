"""Activities, transitions, primitives and clusters of a recording."""
