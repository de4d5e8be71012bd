"""What kineme costs and how often it is right, measured: ``python -m benchmarks``."""
