"""Systems with planar Coulomb friction, event by event: contacts that stick, slide either way, open and strike."""
