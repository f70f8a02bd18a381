"""What the drawings of the ready scenes share."""

from __future__ import annotations

from collections.abc import Sequence

from lagrangian.drawing import Shape

Shapes = Sequence[Shape]
OUTLINE = 240  # corners of a cam
SLIM = 0.08  # of a mechanism: what is drawn with a size of its own
SPOKES = 4
