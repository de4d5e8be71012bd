"""Options that several commands share: recordings, reading, outputs, constants."""
