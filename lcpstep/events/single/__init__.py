"""General systems with one contact or none, whose smooth motion is integrated by DOP853."""
