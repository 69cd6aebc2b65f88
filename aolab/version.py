"""The version, stated once; pyproject.toml and pictures' metadata take it from here."""

__version__ = "0.1.0"
