"""Pixels and files: reading, writing, and arranging pictures."""
