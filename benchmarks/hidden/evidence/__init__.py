"""What the odds rest on: how sharp, how much doubt in sum, and whether the evidence is the integral it stands for."""
