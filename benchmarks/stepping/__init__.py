"""Speed against error of both integrators: `python -m benchmarks.stepping`."""
