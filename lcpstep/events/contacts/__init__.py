"""Systems with contacts and joints, event by event: contacts that open, strike, and with friction stick or slide.

run, with_modes, loop     a run; its loop: what comes next, impacts, new modes, a step of the motion
state, equations, held    the motion at hand; what is measured at a state; its acceleration with rows held
smooth, step, passing     the motion as a field; a step of it, up to the first event, and what that leaves
guards, moments, hops     what ends a mode, and when; short hops, of which gaps tell too little
arrival, surfaces         what an event leads to; who touches, and q put onto the surface; `corners`: those of time
impact, parting           impacts of one instant, what parts between them; `jamming` without collision
chatter                   hops that no longer matter
modes, balance, several   who sticks, slides or opens; whether forces tell; whether others would do
leaning, bracing, loose   what others keep at rest, or wedge; and until when
switching, point          modes of the system; equations at one state, for Python
"""
