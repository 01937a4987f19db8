"""What a mesh carries by name <-> streams, entries in output order."""
