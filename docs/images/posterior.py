"""Draws the probabilities of docs/diagnosis.md from the HUST recordings (a minute): python docs/images/posterior.py"""

from pathlib import Path

import thermoscope as ts
from viz.figures.candidates import posterior

HERE = Path(__file__).parent

if __name__ == "__main__":
    diagnosis = ts.open("hust-ipmsm").diagnose()
    posterior(
        diagnosis.document()["explanations"], title="hust-ipmsm: what the readings say", png=HERE / "posterior.png"
    )
    print(diagnosis.words)
