"""No filter: the estimate with its noise."""

from .base import Filter


class Unfiltered(Filter):
    """The estimate as it is."""

    name = "none"
