"""Derivatives of finished motions by their initial states: variations between events, saltation matrices at them."""
