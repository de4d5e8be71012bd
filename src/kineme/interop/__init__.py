"""Segments and recordings as other libraries have them."""
