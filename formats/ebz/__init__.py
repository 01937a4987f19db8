"""The .ebz container."""
