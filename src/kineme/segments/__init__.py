"""Everything that is true of a result, whoever found it: the table, its editing, its history."""
