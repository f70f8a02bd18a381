"""Models of mechanical systems with unilateral constraints: what moves, and what it may not cross.

Nothing here knows how a motion is computed; see `lcpstep` for that.
"""

from lagrangian import scenes
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.joints import Joints, LinearJoints
from lagrangian.profiles import Arc, CamProfile
from lagrangian.scene import Scene
from lagrangian.system import Harmonic, LinearSystem, System

__all__ = [
    "Arc",
    "CamProfile",
    "Contacts",
    "Coulomb",
    "Harmonic",
    "Joints",
    "LinearContacts",
    "LinearJoints",
    "LinearSystem",
    "Scene",
    "System",
    "scenes",
]
