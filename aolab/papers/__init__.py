"""The figures and tables of the papers: a paper a folder, a figure a file; `FIGURES` lists the functions by name."""

PAPERS = ("ssdo", "s3ho", "hao", "ambient_transfer", "rsm")
