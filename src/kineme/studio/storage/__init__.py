"""Files beside recordings: tables, their history, and settings in ``.kineme``."""
