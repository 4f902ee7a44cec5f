"""Hand networks of permanent-magnet machines, their bases, and what carries over to other machines."""
