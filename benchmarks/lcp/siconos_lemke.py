"""Siconos' Lemke on the problems of a file; run by the interpreter that Siconos is installed for.

python3 siconos_lemke.py problems.npz answers.npz
"""

import sys
import time

import numpy as np
import siconos.numerics as sn

REPEATS = 5


def solve(W, b):
    z, w = np.zeros(len(b)), np.zeros(len(b))
    options = sn.SolverOptions(sn.SICONOS_LCP_LEMKE)
    problem = sn.LCP(W, b)
    start = time.perf_counter()
    info = sn.linearComplementarity_driver(problem, z, w, options)
    return z, info == 0, time.perf_counter() - start


def main(source, target):
    answers = {}
    with np.load(source) as problems:
        for i in range(len(problems.files) // 2):
            W, b = problems[f"W{i}"], problems[f"b{i}"]
            tries = [solve(W.copy(), b.copy()) for _ in range(REPEATS)]
            answers[f"z{i}"] = tries[0][0]
            answers[f"report{i}"] = np.array([tries[0][1], np.median([t for _, _, t in tries])])
    np.savez(target, **answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
