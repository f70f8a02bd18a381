"""A contact that stays closed and rubs along a line: arcs in closed form between slips, stops and reversals."""
