"""Heat transfer to the ambient air that a network lacks, beside whatever cools the face already."""

from lumped.model.network import Network
from lumped.model.quantities import AIR
from lumped.model.sites import AXLE, ambient, outside, role, roleless, turning, turns
from lumped.transfer.laws import Fixed, Law, Power, Radiation as FourthPower
from validation.effects.base import PowerLaw, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid


class AmbientFilm(PowerLaw):
    """Links from every face of a part on the ambient, or one from a bare node."""

    sits = "an outer part or face, with an ambient"
    unit = "W/m2/K"

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = self.unit_and_scale(*film_unit(network, self.place, air))
        links = to_fluid(network, self.name, self.place, air, self.law(network))
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)

    def unit_and_scale(self, unit: str, scale: float) -> tuple[str, float]:
        """Unit and scale of its parameter, from those of a film coefficient there."""
        return unit, scale


class ConstantConvection(AmbientFilm):
    """Extra heat transfer to ambient, constant coefficient a (W/m2/K; W/K at a bare node): mounting, cable, draught."""

    kind = "convection.constant"
    empirical = True
    title = "steady extra cooling to ambient"
    source = "Newton's law of cooling; still air 5 to 15 W/m2/K (Staton and Cavagnino 2008)"
    isolating_test = "insulate the face; cool down with and without it"
    typical = (2.0, 15.0)
    prior_sd = 10.0
    high = 200.0
    confused_with = ("radiation", "convection.buoyant", "conduction.bench", "convection")
    sits = "an outer part or face, or a node of no known role, with an ambient"

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        """Also where the drawing has no way to the ambient, and nobody says that it is inside: leaks, leads."""
        network = scene.network
        bare = [name for name in roleless(network) if network.places[name].kind == "node"]
        return list(dict.fromkeys([*outside(network), *bare])) if ambient(network) else []


class BuoyantConvection(AmbientFilm):
    """h = a (|T - T_ambient| / 40 K)^(1/4), a the coefficient at 40 K (W/m2/K; W/K at a bare node)."""

    kind = "convection.buoyant"
    empirical = True
    title = "natural convection growing with the rise"
    at = "40 K"
    source = "McAdams 1954, vertical plate, laminar, Nu ~ Ra^(1/4)"
    isolating_test = "hold two loss levels to steady state: h must grow with the rise to the power 1/4"
    typical = (1.0, 8.0)
    prior_sd = 5.0
    high = 100.0
    confused_with = ("convection.constant", "radiation")

    def law(self, network: Network) -> Law:
        return Fixed(40.0**-0.25, Power(0.25))


class Convection(AmbientFilm):
    """Forced convection by vehicle wind, parallel to whatever cools the face already.

    h = a (v / 10 m/s)^0.8, v the vehicle's speed (m/s), a the coefficient at 10 m/s (W/m2/K; W/K at a bare node).
    """

    kind = "convection"
    empirical = True
    title = "forced convection by vehicle wind"
    source = "McAdams 1954, turbulent flat plate, Nu ~ Re^0.8"
    isolating_test = "roll at two speeds with the motor off; blow on the face and shield it"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("convection.constant", "flow", "windage", "sensor.stem")
    follows = (("vehicle_speed", 10.0, 0.8),)


class RotationConvection(AmbientFilm):
    """Cooling of a turning part to ambient: h = a (n / 1000 rpm)^0.7 (W/m2/K; W/K at a bare node)."""

    kind = "convection.rotation"
    empirical = True
    title = "cooling of a turning part to ambient"
    sits = "a turning part, with an ambient"
    source = "rotating cylinder in still air, Nu = 0.133 Re^(2/3) Pr^(1/3) (Kays and Bjorklund 1958)"
    isolating_test = "cool down at several speeds without current"
    typical = (1.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("gap.convection", "loss.rotor")
    follows = (("speed", 1000.0, 0.7),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return turning(scene.network) if ambient(scene.network) else []


class FanConvection(AmbientFilm):
    """Air of a shaft fan over a standing face, parallel to what cools it already: h = a (n / 1000 rpm)^0.8.

    a the coefficient at 1000 rpm (W/m2/K; W/K at a bare node); the fan's flow goes with its speed (affinity).
    """

    kind = "convection.fan"
    empirical = True
    title = "air of a fan on the shaft over a standing face"
    sits = "a standing outer part off the axle, with no air flow recorded"
    source = "fin channels and end shields of TEFC machines, h ~ v^0.8 (Staton and Cavagnino 2008), v ~ n"
    isolating_test = "cool down without current, once turning and once at rest; take the fan off"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("convection", "convection.constant", "convection.rotation", "windage")
    follows = (("speed", 1000.0, 0.8),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        if AIR in scene.recorded:  # a motor of its own drives the fan: then none is on the shaft
            return []
        return [p for p in outside(network) if not turns(network, p) and role(network, p) not in AXLE]


class Radiation(AmbientFilm):
    """q = a sigma A (T^4 - T_ambient^4), a the extra effective emissivity (1; emissivity times m2 at a bare node)."""

    kind = "radiation"
    title = "thermal radiation to the surroundings"
    unit = "1"
    source = "Stefan-Boltzmann; grey body in large surroundings"
    isolating_test = "paint the face matt black or cover it with bright foil; wide range of temperature"
    typical = (0.1, 0.9)
    prior_sd = 0.5
    high = 1.0
    confused_with = ("convection.constant", "convection.buoyant")

    def law(self, network: Network) -> Law:
        return Fixed(1.0, FourthPower())

    def unit_and_scale(self, unit: str, scale: float) -> tuple[str, float]:
        """An emissivity; at a bare node times an area."""
        return ("1", 1.0) if unit == "W/m2/K" else ("m2", scale / 5.0)
