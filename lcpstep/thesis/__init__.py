"""The figures and the numbers of the thesis this library reproduces, each made by one command.

Source: G. Osorio, Complex Behavior in Impacting Systems (PhD thesis, University of Naples Federico II).
"""

from lcpstep.thesis.catalogue import FIGURES, FigureOfThesis, make

__all__ = ["FIGURES", "FigureOfThesis", "make"]
