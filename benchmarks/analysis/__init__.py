"""Studies of the cam-follower: seconds, and agreement of the two integrators in them."""
