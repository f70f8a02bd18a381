"""The Moreau theta-method, as kernels: a step in `theta_step`, the loop over steps in `theta_loop`."""
