"""OBJ files."""
