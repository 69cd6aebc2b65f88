"""Exercises for a course: students write parts of a shader; exact answers and rays check them (docs/exercises.md)."""

from .check import check as check
from .exercise import Exercise as Exercise
from .exercise import exercise as exercise
from .exercise import exercises as exercises
from .grade import checked_apart as checked_apart
from .grade import grade as grade
from .new import new as new
from .pictures import show as show
from .results import Result as Result
from .start import start as start
