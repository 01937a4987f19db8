"""Bytes to structures and back: mesh files at one end, the .ebz container at the other."""
