"""What contacts, friction and joints ask of velocities and positions, as kernels that no method owns."""
