"""The figures and tables of the papers. Each paper is a folder; its table `FIGURES` lists a function a figure."""

PAPERS = ("ssdo", "s3ho")
