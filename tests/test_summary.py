"""The summary of a run that a notebook shows."""

import numpy as np

from lcpstep.summary import HEIGHT, sparkline


def test_a_sparkline_keeps_every_peak():
    t, x = np.linspace(0.0, 1.0, 100_000), np.zeros(100_000)
    x[54_321] = 1.0
    assert "130.4,2.0" in sparkline(t, x, np.zeros(0))
    assert f"M120.0 {HEIGHT}" in sparkline(t, x, np.array([0.5]))
    assert sparkline(t[:1], x[:1], np.zeros(0)) == ""
