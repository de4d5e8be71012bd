"""Results of segmentation, independent of the method: the table, its editing, its history."""
