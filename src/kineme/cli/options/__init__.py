"""What several commands ask for: recordings, how to read them, where to write, constants."""
