"""A synthetic motor for the tests: the model by hand, the truth by an independent integrator with other formulas.

The truth shares no code with the rooms: every node is split into core and skin, films follow other exponents than the
model's, parameters are drawn from the priors, sensors have noise, bias, lag and 0.1 K steps.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from lumped.model.network import Link, Network, Parameter, Place, Row, Source
from lumped.transfer.laws import Constant, Fixed, InputPower, Linear, Power
from measured.case import Case, Channel, Model, Test

# J/K
NODES = {"shaft": 14e3, "rotor": 70e3, "winding.armature": 25e3, "commutator": 10e3, "yoke": 90e3, "poles": 60e3}
NODES |= {"winding.field": 30e3, "housing": 50e3, "flange.left": 16e3, "flange.right": 16e3}
NODES |= {"bearing.left": 3e3, "bearing.right": 3e3}
NAMES = tuple(NODES)
JOINTS = {  # W/K
    ("rotor", "shaft"): 25.0,
    ("rotor", "winding.armature"): 60.0,
    ("commutator", "winding.armature"): 12.0,
    ("commutator", "shaft"): 8.0,
    ("poles", "rotor"): 9.0,
    ("poles", "winding.field"): 25.0,
    ("poles", "yoke"): 80.0,
    ("housing", "yoke"): 120.0,
    ("flange.left", "housing"): 18.0,
    ("flange.right", "housing"): 18.0,
    ("bearing.left", "flange.left"): 6.0,
    ("bearing.right", "flange.right"): 6.0,
    ("bearing.left", "shaft"): 5.0,
    ("bearing.right", "shaft"): 5.0,
}
FILMS = {"housing": 14.0, "flange.left": 2.0, "flange.right": 2.0}  # W/K at 40 K, natural
# W/K at the stated flow
FAN = {"rotor": 9.0, "winding.field": 7.0, "poles": 5.0, "flange.left": 3.0, "commutator": 3.0}
COPPER = {"winding.armature": 0.028, "winding.field": 0.022}  # ohm at 20 degC
IRON = {"rotor": 60.0, "poles": 20.0}  # W at 1000 rpm
FRICTION = {"bearing.left": 8.0, "bearing.right": 8.0}  # W at 1000 rpm
SENSORS = ("flange.left", "flange.right", "housing", "yoke", "poles", "winding.field", "bearing.left", "bearing.right")
ALPHA = 0.00393


def row(index):
    return Row(np.array([index]), np.array([1.0]))


def link(name, kind, a, b, law):
    n = len(NAMES)
    i = NAMES.index(a)
    j = NAMES.index(b) if b in NAMES else n
    both = [(i, i, 1.0), (i, j, -1.0)] + ([(j, j, 1.0), (j, i, -1.0)] if j < n else [])
    r, c, v = (np.array(x) for x in zip(*both))
    return Link(name, kind, (a, b), r, c, v.astype(float), law, row(i), row(j))


def source(kind, place, law):
    i = NAMES.index(place)
    return Source(f"loss:{kind}.{place}", kind, place, np.array([i]), np.array([1.0]), law, row(i))


def network(feedback=True):
    """The model: constant joints, natural films ~ dT^0.25, fan films ~ flow^0.8, copper, iron ~ n^1.5, friction ~ n."""
    links = [link(f"contact:{a}|{b}", "contact", a, b, Fixed(G)) for (a, b), G in JOINTS.items()]
    natural = Power(0.25)
    links += [link(f"film:{a}", "film", a, "ambient", Fixed(G * 40**-0.25, natural)) for a, G in FILMS.items()]
    fan = (("fan_flow_m3h", 138.0, 0.8),)
    links += [link(f"film:{a}:fan", "film", a, "ambient", InputPower(G, fan)) for a, G in FAN.items()]
    warm = Linear(ALPHA, 20.0) if feedback else Constant()
    sources = [source("copper", p, InputPower(R, (("current_A", 1.0, 2.0),), warm)) for p, R in COPPER.items()]
    sources += [source("iron", p, InputPower(P, (("speed_rpm", 1000.0, 1.5),))) for p, P in IRON.items()]
    sources += [source("friction", p, InputPower(P, (("speed_rpm", 1000.0, 1.0),))) for p, P in FRICTION.items()]
    places = {a: Place(a, "node", a, np.array([i]), np.eye(1), np.ones(1)) for i, a in enumerate(NAMES)}
    for a in FILMS:
        places[a] = Place(a, "node", a, np.array([NAMES.index(a)]), np.eye(1), np.ones(1), fluid="ambient")
    C, free = np.array(list(NODES.values())), parameters(links, sources)
    return Network("playground", NAMES, C, ("ambient",), tuple(links), tuple(sources), places, NAMES, free)


def parameters(links, sources):
    out = [Parameter(f"contact.{x.name[8:]}", ((x.name, 1.0),), prior_sd=0.25) for x in links if x.kind == "contact"]
    out += [Parameter(f"h.{a}", ((f"film:{a}", 1.0),), prior_sd=0.3) for a in FILMS]
    out += [Parameter("fan.flow", tuple((f"film:{a}:fan", 0.8) for a in FAN), prior_sd=0.1)]
    sd = {"copper": 0.05, "iron": 0.2, "friction": 0.3}
    out += [Parameter(s.name.replace(":", ".", 1), ((s.name, 1.0),), prior_sd=sd[s.kind]) for s in sources]
    out += [Parameter(f"capacity.{a}", ((f"capacity:{a}", 1.0),), prior_sd=0.1) for a in NAMES]
    return tuple(out)


@dataclass
class Truth:
    """The real machine: drawn parameters, other formulas, a hidden effect.

    hidden(T, u, t) -> {node: W}, with T a dictionary of temperatures and u of inputs and air
    """

    seed: int = 0
    hidden: object = None
    spread: float = 1.0
    bias: dict = field(default_factory=dict)
    lag: dict = field(default_factory=dict)
    change: dict = field(default_factory=dict)
    sensors: tuple = SENSORS

    def __post_init__(self):
        rng = self.rng = np.random.default_rng(self.seed)

        def draw(table, sd):
            return {k: v * np.exp(self.spread * sd * rng.standard_normal()) for k, v in table.items()}

        self.C, self.joints = draw(NODES, 0.1), draw(JOINTS, 0.25)
        self.films, self.fan = draw(FILMS, 0.3), draw(FAN, 0.1)
        self.copper, self.iron, self.friction = draw(COPPER, 0.05), draw(IRON, 0.2), draw(FRICTION, 0.3)
        self.fan_exponent = 0.63 + 0.1 * rng.uniform()
        self.natural_exponent = 0.25 + 0.08 * rng.uniform()
        self.iron_exponent = 1.3 + 0.3 * rng.uniform()
        self.real_bias = {s: 0.4 * rng.standard_normal() + self.bias.get(s, 0.0) for s in self.sensors}
        self.real_lag = {s: 5.0 + 10.0 * rng.uniform() + self.lag.get(s, 0.0) for s in self.sensors}
        for table, key, factor in self.change.values():
            getattr(self, table)[key] *= factor

    def heat(self, T, u, air, t):
        """Heat into every node (W)."""
        q = dict.fromkeys(NAMES, 0.0)
        for (a, b), G in self.joints.items():
            q[a] -= G * (T[a] - T[b])
            q[b] += G * (T[a] - T[b])
        for a, G in self.films.items():
            q[a] -= G * (abs(T[a] - air) / 40.0) ** self.natural_exponent * (T[a] - air)
        for a, G in self.fan.items():
            q[a] -= G * (u["fan_flow_m3h"] / 138.0) ** self.fan_exponent * (T[a] - air)
        for a, R in self.copper.items():
            q[a] += R * u["current_A"] ** 2 * (1.0 + ALPHA * (T[a] - 20.0))
        for a, P in self.iron.items():
            q[a] += P * (u["speed_rpm"] / 1000.0) ** self.iron_exponent
        for a, P in self.friction.items():
            q[a] += P * (u["speed_rpm"] / 1000.0) ** 1.1
        for a, P in (self.hidden(T, {**u, "air": air}, t) if self.hidden else {}).items():
            q[a] += P
        return q

    def run(self, time, inputs, air, start):
        """Temperatures of the skins (n_time, n_node): every node is a core (70 %) and a skin (30 %), 40 s apart."""
        C = np.array([self.C[a] for a in NAMES])
        G = C * 0.21 / 40.0
        n = len(NAMES)

        def slope(t, x):
            core, skin = x[:n], x[n:]
            u = {k: np.interp(t, time, v) for k, v in inputs.items()}
            mean = 0.7 * core + 0.3 * skin
            q = self.heat(dict(zip(NAMES, mean)), u, np.interp(t, time, air), t)
            flow, q = G * (core - skin), np.array([q[a] for a in NAMES])
            return np.concatenate([(0.7 * q - flow) / (0.7 * C), (0.3 * q + flow) / (0.3 * C)])

        x0 = np.full(2 * n, start)
        done = solve_ivp(slope, (time[0], time[-1]), x0, "LSODA", time, rtol=1e-6, atol=1e-6, max_step=60.0)
        return done.y[n:].T

    def test(self, name, role, plan, hours=1.0):
        """A measured test: plan(time, rng) -> inputs."""
        time = np.arange(0.0, 3600.0 * hours, 10.0)
        rng = np.random.default_rng([self.seed, sum(map(ord, name))])
        inputs = plan(time, rng)
        air = 20.0 + 4.0 * rng.uniform() + 0.5 * np.sin(time / 900.0 + rng.uniform())
        T = self.run(time, inputs, air, start := float(air[0] + rng.uniform()))
        channels = []
        for s in self.sensors:
            seen = slow(time, T[:, NAMES.index(s)], self.real_lag[s]) + self.real_bias[s]
            seen = seen + 0.05 * rng.standard_normal(time.size)
            channels.append(Channel(s, s, row(NAMES.index(s)), np.round(seen, 1), 0.5, 10.0))
        read = air + 0.2 * rng.standard_normal()
        return Test(name, role, time, inputs, {"ambient": read}, tuple(channels), start + 0.3 * rng.standard_normal())

    def case(self, model=None):
        plans = {
            "stand-1": ("calibrate", stand(225.0, 700.0)),
            "stand-2": ("calibrate", stand(270.0, 1000.0)),
            "road-1": ("validate", road(11.0)),
            "road-2": ("hold-out", road(9.0)),
        }
        tests = tuple(self.test(name, role, plan) for name, (role, plan) in plans.items())
        return Case(f"playground-{self.seed}", Model(model or network()), tests)


def slow(time, T, tau):
    out = np.array(T)
    keep = np.exp(-(time[1] - time[0]) / tau)
    for i in range(1, time.size):
        out[i] = keep * out[i - 1] + (1.0 - keep) * 0.5 * (T[i] + T[i - 1])
    return out


def steps(time, rng, low, high, every):
    levels = rng.uniform(low, high, int(time[-1] / every) + 1)
    return levels[(time / every).astype(int)]


def driven(current, vehicle, speed, fan):
    return {"current_A": current, "vehicle_speed_mps": vehicle, "speed_rpm": speed, "fan_flow_m3h": fan}


def stand(current, speed):
    def plan(time, rng):
        fan = np.where(time > 2400.0, 90.0, 138.0)
        amps = steps(time, rng, 0.6 * current, current, 900.0)
        return driven(amps, np.zeros_like(time), steps(time, rng, 0.3 * speed, speed, 1200.0), fan)

    return plan


def road(top):
    def plan(time, rng):
        v = np.convolve(steps(time, rng, 0.2 * top, top, 240.0), np.ones(6) / 6, mode="same")
        return driven(steps(time, rng, 130.0, 380.0, 180.0), v, 90.0 * v, np.full_like(time, 138.0))

    return plan


def wind(place, strength):
    """Hidden convection by road wind, Re^0.63 (W/K at 10 m/s)."""

    def hidden(T, u, t):
        return {place: -strength * (u["vehicle_speed_mps"] / 10.0) ** 0.63 * (T[place] - u["air"])}

    return hidden
