"""Tables of single devices and their programs: one module each, which ends in one `Dialect`."""
