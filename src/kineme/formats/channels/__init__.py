"""Channels without a skeleton: from tables, MOT and STO, Parquet, C3D, MAT."""
