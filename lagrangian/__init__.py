"""Models of mechanical systems with unilateral constraints: what moves, and what it may not cross.

Nothing here knows how a motion is computed; see `lcpstep` for that. Every name is imported from its module when it is
first asked for.
"""

from typing import TYPE_CHECKING

from lagrangian.lazy import lazily

if TYPE_CHECKING:
    from lagrangian import scenes
    from lagrangian.contacts import Contacts, LinearContacts
    from lagrangian.friction import Coulomb
    from lagrangian.hybrid import HybridScene, HybridSystem
    from lagrangian.joints import Joints, LinearJoints
    from lagrangian.modes import Guard, Mode, Surface
    from lagrangian.profiles import Arc, CamProfile
    from lagrangian.scene import Scene
    from lagrangian.system import Harmonic, LinearSystem, System
else:
    __getattr__ = lazily(
        globals(),
        {
            "lagrangian.contacts": "Contacts LinearContacts",
            "lagrangian.friction": "Coulomb",
            "lagrangian.hybrid": "HybridScene HybridSystem",
            "lagrangian.joints": "Joints LinearJoints",
            "lagrangian.modes": "Guard Mode Surface",
            "lagrangian.profiles": "Arc CamProfile",
            "lagrangian.scene": "Scene",
            "lagrangian.system": "Harmonic LinearSystem System",
        },
    )

__all__ = [
    "Arc",
    "CamProfile",
    "Contacts",
    "Coulomb",
    "Guard",
    "Harmonic",
    "HybridScene",
    "HybridSystem",
    "Joints",
    "LinearContacts",
    "LinearJoints",
    "LinearSystem",
    "Mode",
    "Scene",
    "Surface",
    "System",
    "scenes",
]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
