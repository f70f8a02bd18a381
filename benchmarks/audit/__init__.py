"""Random motions with narrow burrs and near-tangent passages: is an event missed, and does the audit say so?"""
