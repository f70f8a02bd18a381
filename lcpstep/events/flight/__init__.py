"""One linear degree of freedom above a flat obstacle, whose flights are known in closed form."""
