"""What lies beside recordings: tables, their history, and small files in ``.kineme``."""
