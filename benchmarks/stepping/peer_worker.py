"""The three scenes in Siconos, driven by requests on standard input; run by a Python that has Siconos.

One JSON object a line in, one out. A request {"scene", "method", "t_end", "h", "save", ...} is one run; its answer
holds the processor seconds of the time loop alone (the model is built before the clock starts), the number of
steps, and the last state. With "save" the states (t, q, v) of every step go into that .npy file, and the seconds
mean nothing.

Methods, all with theta = 1/2, one contact, Siconos' default complementarity solver and activation rule:

    run        the time loop of the C++ library (`TimeStepping.run`), forces from the C plugin
    python     the time loop in Python (`computeOneStep`, `nextStep`), forces from the C plugin
    force      the time loop in Python, the force a Python function
    events     `EventDriven` with the integrator LSODAR, the loop in Python
"""

import json
import math
import os
import sys
import time

import numpy as np

CAM_RPM = 358.0


def cam_force(t):
    """-(m c'' + k c) of the cam, as in forces.c."""
    mass, stiffness, omega, half = 1.221, 1430.8, 2.0 * math.pi * CAM_RPM / 60.0, math.pi / 2
    beta = (omega * t + half) % (2.0 * math.pi)
    beta = min(beta, 2.0 * math.pi - beta)
    if beta < half:
        return -stiffness * (0.40 - 0.3)
    if beta > half + 1.22173047639603:
        return -stiffness * (0.55393320723821 - 0.3)
    if beta <= half + 1.050328174371336:
        a, b, rho = -0.45 * math.sin(beta), 0.45 * math.cos(beta), 0.85
    else:
        angle = beta + math.pi / 9
        a, b, rho = -0.40393320723821 * math.cos(angle), -0.40393320723821 * math.sin(angle), 0.15
    root = math.sqrt(rho * rho - b * b)
    second = -a - (a * a - b * b) / root - (a * b) ** 2 / root**3
    return -(mass * omega * omega * second + stiffness * (a + root - 0.3))


def oscillator_force(t):
    return math.cos(2.0 * t)


# q0, v0, mass, stiffness, damping, side of the contact, constant force or name in the plugin, Python function
SCENES = {
    "bouncing-ball": (1.0, 0.0, 1.0, 0.0, 0.0, 1.0, -9.81, None),
    "impact-oscillator": (-0.5, 0.0, 1.0, 1.0, 0.1, -1.0, "oscillator_force", oscillator_force),
    "cam-follower": (0.4, 0.4, 1.221, 1430.8, 0.0, 1.0, "cam_force", cam_force),
}


def build(sk, name, t_end, plugin, python_force):
    """The scene's model, its one body, and the interaction with the obstacle."""
    q0, v0, mass, stiffness, damping, side, force, function = SCENES[name]

    class Follower(sk.LagrangianLinearTIDS):
        def computeFExt(self, t):
            self.force.setValue(0, function(t))

    start = ([q0], [v0], [[mass]])
    matrices = ([[stiffness]], [[damping]]) if stiffness or damping else ()
    if python_force and function:
        body = Follower(*start, *matrices)
        body.force = sk.SiconosVector(1)
        body.setFExtPtr(body.force)
    else:
        body = sk.LagrangianLinearTIDS(*start, *matrices)
        if isinstance(force, float):
            body.setFExtPtr([force])
        else:
            body.setComputeFExtFunction(plugin, force)
    contact = sk.Interaction(sk.NewtonImpactNSL(0.8), sk.LagrangianLinearTIR([[side]]))
    model = sk.NonSmoothDynamicalSystem(0.0, t_end)
    model.insertDynamicalSystem(body)
    model.link(contact, body)
    return model, body, contact


def stepping(sk, request):
    """One run of Moreau-Jean time-stepping."""
    method, t_end, h = request["method"], request["t_end"], request["h"]
    model, body, _ = build(sk, request["scene"], t_end, request.get("plugin"), method == "force")
    clock = sk.TimeDiscretisation(0.0, h)
    simulation = sk.TimeStepping(model, clock, sk.MoreauJeanOSI(0.5), sk.LCP())
    rows = [(0.0, float(body.q()[0]), float(body.velocity()[0]))]
    begin = time.process_time()
    if method == "run":
        simulation.run()
    elif not request.get("save"):
        while simulation.hasNextEvent():
            simulation.computeOneStep()
            simulation.nextStep()
    else:
        while simulation.hasNextEvent():
            simulation.computeOneStep()
            rows.append((simulation.nextTime(), float(body.q()[0]), float(body.velocity()[0])))
            simulation.nextStep()
    return time.process_time() - begin, round(t_end / h), rows, body


def events(sk, request):
    """One event-driven run; h is the distance of the times at which the state is looked at."""
    model, body, _ = build(sk, request["scene"], request["t_end"], request.get("plugin"), False)
    integrator = sk.LsodarOSI()
    if "tolerance" in request:
        integrator.setTol(1, float(request["tolerance"]), float(request["tolerance"]))
    simulation = sk.EventDriven(model, sk.TimeDiscretisation(0.0, request["h"]))
    simulation.insertIntegrator(integrator)
    simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_IMPACT)
    simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_SMOOTH_ACC)
    rows, impacts = [(0.0, float(body.q()[0]), float(body.velocity()[0]))], 0
    begin = time.process_time()
    while simulation.hasNextEvent():
        simulation.advanceToEvent()
        impacts += simulation.eventsManager().nextEvent().getType() == sk.NS_EVENT
        simulation.processEvents()
        rows.append((simulation.startingTime(), float(body.q()[0]), float(body.velocity()[0])))
    return time.process_time() - begin, impacts, rows, body


def answer(sk, request):
    """What one request asks for; an exception becomes an answer too."""
    if request["scene"] is None:
        return {"version": version()}
    try:
        seconds, steps, rows, body = (events if request["method"] == "events" else stepping)(sk, request)
    except Exception as error:
        return {"error": f"{type(error).__name__}: {str(error).strip()[:200]}"}
    if request.get("save"):
        np.save(request["save"], np.array(rows))
    return {"seconds": seconds, "steps": steps, "q": float(body.q()[0])}


def version():
    """Version of the Debian package, if it is one."""
    import subprocess

    query = ["dpkg-query", "-W", "-f", "${Version}", "python3-siconos"]
    try:
        return subprocess.run(query, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def main():
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # Siconos talks on standard output
    import siconos.kernel as sk

    for line in sys.stdin:
        answers.write(json.dumps(answer(sk, json.loads(line))) + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
