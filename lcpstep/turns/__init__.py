"""Where an obstacle or a frame that moves by itself turns fast, so that runs look finely there and only there."""

from lcpstep.turns.stops import FastTurn, Turns, jolts, turns

__all__ = ["FastTurn", "Turns", "jolts", "turns"]
