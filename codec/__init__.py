"""Structures to structures: connectivity, models, lattices, streams; no files."""
