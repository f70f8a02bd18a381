"""The column of `column.py` in Siconos, run by a Python that has it: arguments N CASE STEPS SOLVER, prints JSON.

The time is that of the time loop alone, without building the model.
"""

import json
import os
import resource
import sys
import time

import numpy as np


def main():
    n, case, steps, name = int(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4]
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # Siconos talks on standard output
    import siconos.kernel as sk
    import siconos.numerics as sn

    h, followed = 1e-3, case == "falling" and n <= 100  # the same as in `column.py`
    model = sk.NonSmoothDynamicalSystem(0.0, 2.0 * h * steps)
    bodies = []
    for i in range(n):
        body = sk.LagrangianLinearTIDS([0.0 if case == "touching" else 1e-3 * (i + 1)], [0.0], [[1.0]])
        body.setFExtPtr([-9.81])
        model.insertDynamicalSystem(body)
        bodies.append(body)
    law = sk.NewtonImpactNSL(0.5)
    model.link(sk.Interaction(law, sk.LagrangianLinearTIR([[1.0]])), bodies[0])
    for i in range(1, n):
        model.link(sk.Interaction(law, sk.LagrangianLinearTIR([[-1.0, 1.0]])), bodies[i - 1], bodies[i])
    problem = sk.LCP(getattr(sn, name))
    problem.numericsSolverOptions().iparam[0] = 100000
    clock = sk.TimeDiscretisation(0.0, h)
    simulation = sk.TimeStepping(model, clock, sk.MoreauJeanOSI(0.5), problem)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    begin = time.process_time()
    states = []
    for k in range(1, steps + 1):
        simulation.computeOneStep()
        simulation.nextStep()
        if followed and k % (steps // 20) == 0:
            states.append([(body.q()[0], body.velocity()[0]) for body in bodies])
    seconds = (time.process_time() - begin) / steps
    megabytes = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    q = np.array([body.q()[0] for body in bodies])
    v = np.array([body.velocity()[0] for body in bodies])
    error = np.max(np.abs(v)) if case == "touching" else max(0.0, -np.min(np.diff(q, prepend=0.0)))
    answer = {"seconds": seconds, "megabytes": megabytes, "error": float(error)}
    if followed:
        q, v = np.moveaxis(np.array(states), 2, 0)
        answer.update(q=q.tolist(), v=v.tolist())
    answers.write(json.dumps(answer) + "\n")


if __name__ == "__main__":
    main()
