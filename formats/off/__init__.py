"""OFF files."""
