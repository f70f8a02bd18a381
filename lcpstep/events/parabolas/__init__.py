"""Contacts and joints under constant accelerations, without friction: exact from impact to impact."""
