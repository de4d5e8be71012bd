"""Formats of named arrays: npz and npy, AMASS, MAT, HDF5."""
