"""Poincare maps: a motion with impacts as a map x -> P(x) that can be iterated.

`StroboscopicMap`: the state once per period of the forcing, of any scene by either integrator, and of one with modes.
`ImpactMap`: from one impact to the next. `EventMap`: from one event of a contact, with friction too, to the next.
`SwitchMap`: from one entry into a mode to the next. `formulas`: maps given by formulas.
`sections` looks at one long motion on both sections at once.
"""

from lcpstep.maps.batch import Periods, periods
from lcpstep.maps.event import EventMap
from lcpstep.maps.impact import ImpactMap
from lcpstep.maps.iteration import iterate
from lcpstep.maps.phase import NoReturn
from lcpstep.maps.sections import Sections, sections
from lcpstep.maps.stroboscopic import StroboscopicMap
from lcpstep.maps.switch import SwitchMap

__all__ = [
    "EventMap",
    "ImpactMap",
    "NoReturn",
    "Periods",
    "Sections",
    "StroboscopicMap",
    "SwitchMap",
    "iterate",
    "periods",
    "sections",
]
