"""Steps of one size of systems with planar friction, every slip, stick and impact at its own time within the step.

Modes, impacts and what decides about them are those of `events.friction`; the motion between is that of `strides`.
"""
