"""Systems with modes, guards and resets: controllers, Filippov systems."""
