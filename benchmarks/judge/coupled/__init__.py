"""Random scenes of bodies whose contacts hang together, and what is asked of runs on them."""
