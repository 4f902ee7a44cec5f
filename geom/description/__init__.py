"""What a machine is: its parts as prisms, their materials and roles, and the file that says so."""
