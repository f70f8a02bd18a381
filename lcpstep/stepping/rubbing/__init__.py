"""Steps of systems with planar friction or joints, every slip, stick and impact at its own time within the step.

run       a run;  steps   what its loop calls, that of `events.contacts`, with the modes and impacts of that
stride    one step up to its first event;  found   that event, and its time;  let_go   those of what has just opened
strides   the motion between: steps of order two or four;  paced   those by a tolerance
"""
