"""One contact that stays closed and rubs, along a line: arcs known in closed form between slips, stops and reversals."""
