"""The papers' figures and tables, drawn anew: PAPER.py holds `FIGURES`, a function each; see `aolab/reproduce.py`."""

PAPERS = ("ssdo", "s3ho")
