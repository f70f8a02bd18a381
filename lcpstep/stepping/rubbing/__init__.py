"""Steps of systems with planar friction or joints, every slip, stick and impact at its own time within the step.

They are of one size, or chosen by a tolerance (`paced`). Modes, impacts and what decides about them are those of
`events.contacts`; the motion between is that of `strides`.
"""
