"""How far a run can be trusted: its distance to a companion of another method, as an error bar."""
