"""Tables whose columns are coordinates of joints."""
