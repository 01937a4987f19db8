"""Probability models of reverse CLRSE words: theory, tables and certificates."""
