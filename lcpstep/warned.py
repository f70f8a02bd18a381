"""Warnings that point at the line of the user's program that the library was called from, however deep inside."""

from __future__ import annotations

import os
import sys
import warnings

INSIDE = os.path.dirname(__file__) + os.sep


def warn(message: str, category: type[Warning]) -> None:
    """Warn in the name of the nearest caller outside of the package."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_code.co_filename.startswith(INSIDE):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)
