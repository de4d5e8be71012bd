"""Small files that the studio keeps in ``.kineme`` besides tables and their history."""
