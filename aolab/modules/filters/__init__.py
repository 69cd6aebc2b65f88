"""How noise is removed: one filter a file. This table is all the registry there is."""

from .base import Filter
from .bilateral import Bilateral
from .box4 import Box4
from .none import Unfiltered
from .wendland import Wendland

FILTERS: dict[str, type[Filter]] = {filter.name: filter for filter in (Unfiltered, Box4, Bilateral, Wendland)}
