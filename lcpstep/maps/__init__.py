"""Poincare maps: a motion with impacts as a map x -> P(x) that can be iterated.

`StroboscopicMap`: the state once per period of the forcing. `ImpactMap`: from one impact to the next. Both take
any scene and either integrator. `sections` looks at one long motion on both sections at once.
"""

from lcpstep.maps.batch import Periods, periods
from lcpstep.maps.impact import ImpactMap, NoReturn
from lcpstep.maps.iteration import iterate
from lcpstep.maps.sections import Sections, sections
from lcpstep.maps.stroboscopic import StroboscopicMap

__all__ = [
    "ImpactMap",
    "NoReturn",
    "Periods",
    "Sections",
    "StroboscopicMap",
    "iterate",
    "periods",
    "sections",
]
