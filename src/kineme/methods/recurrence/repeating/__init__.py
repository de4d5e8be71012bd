"""What repeats: repetitions back to back, occurrences anywhere, their ends and parts."""
