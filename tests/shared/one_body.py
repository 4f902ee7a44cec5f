"""One mass with one film and one loss, linear or log in its parameters: what a fit must find is known by hand."""

import numpy as np

from lumped.model.network import Link, Network, Parameter, Place, Row, Source
from lumped.transfer.laws import Fixed
from measured.case import Channel, Test

P, G, C, SIGMA = 50.0, 2.0, 4000.0, 0.3


def one_node(*parameters):
    """One mass, one film to ambient, one constant loss."""
    row, air = Row(np.array([0]), np.ones(1)), Row(np.array([1]), np.ones(1))
    at, ends = (np.array([0, 0]), np.array([0, 1]), np.array([1.0, -1.0])), ("body", "ambient")
    film = Link("film", "film", ends, *at, Fixed(G), row, air)
    loss = Source("loss", "measured", "body", np.array([0]), np.ones(1), Fixed(P), row)
    place = Place("body", "node", "body", np.array([0]), np.eye(1), np.ones(1))
    mass, places = np.array([C]), {"body": place}
    return Network("one", ("body",), mass, ("ambient",), (film,), (loss,), places, ("body",), parameters)


def measured(name="warm", role="calibrate", frees=(), shift=0.0, loss=1.0, samples=200):
    time = 100.0 * np.arange(samples)
    y = 20.0 + loss * P / G * (1.0 - np.exp(-time * G / C)) + shift
    channel = Channel("body", "body", Row(np.array([0]), np.ones(1)), y, SIGMA)
    air = {"ambient": np.full_like(time, 20.0)}
    return Test(name, role, time, {}, air, (channel,), 20.0, frees)


LOSS = Parameter("loss", (("loss", 1.0),), prior_sd=0.2, mapping="relative", value=0.0, neutral=0.0, low=-0.9, high=9.0)
FILM = Parameter("film", (("film", 1.0),), prior_sd=0.3)
MASS = Parameter("mass", (("capacity:body", 1.0),), prior_sd=0.1)
