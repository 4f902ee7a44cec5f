"""A case's model beside a running machine, and over a fleet of machines."""
