"""Rows of joints, contacts and tangents at one state: what both loops over events of several contacts share."""
