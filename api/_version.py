"""The one place that holds the version of ebz."""

__version__ = "0.1.0"
