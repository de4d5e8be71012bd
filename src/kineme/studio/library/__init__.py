"""A library in the studio: its page, its recordings as a folder, searches and edits."""
