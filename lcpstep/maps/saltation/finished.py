"""What a finished run is read as by those who walk along it: its scene with friction, its log by what is closed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from lagrangian import Coulomb, Scene
from lcpstep.trajectory import Kind, Trajectory


def with_friction(scene: Scene) -> Scene:
    """The scene, with friction of coefficient zero where it has none."""
    contacts: Any = scene.contacts
    if contacts is None or contacts.friction is not None:
        return scene
    none = Coulomb(0.0, np.zeros((scene.n_c, scene.n_q)))
    return replace(scene, contacts=replace(contacts, friction=none))


def closed_at_once(run: Trajectory) -> Any:
    """The log, with the ends of chattering where the contact counts as closed: at the event before them."""
    log, t = run.impacts.copy(), float(run.t[0])
    for k, event in enumerate(run.impacts):
        shifted = event.kind == Kind.STICK and k > 0 and run.impacts[k - 1].kind == Kind.ACCUMULATION
        if event.kind == Kind.ACCUMULATION or shifted:
            log.time[k] = t
        t = float(log.time[k])
    return log
