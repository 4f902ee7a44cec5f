"""See it: fields, residuals and the error falling. Nothing heavy is loaded before the first picture."""

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from viz.data import Comparison as Comparison, Sensor as Sensor, sensors as sensors
    from viz.figures.bands import Predicted as Predicted, missing_heat as missing_heat, predicted as predicted
    from viz.figures.candidates import confusion as confusion, posterior as posterior, scores as scores
    from viz.figures.curves import measured_and_model as measured_and_model, residuals as residuals
    from viz.figures.errors import before_after as before_after, staircase as staircase
    from viz.figures.flows import heat_flows as heat_flows
    from viz.figures.bands import intervals as intervals
    from viz.figures.flows import sankey_of_losses as sankey_of_losses
    from viz.machine.animation import animate as animate
    from viz.machine.arrows import flux_arrows as flux_arrows
    from viz.machine.field import cutaway as cutaway, difference as difference, machine_row as machine_row, pair as pair
    from viz.machine.field import uncertainty as uncertainty
    from viz.machine.misses import misses as misses
    from viz.machine.missing import missing_in_machine as missing_in_machine
    from viz.machine.network import network_in_machine as network_in_machine
    from viz.machine.parts import exploded as exploded, regions as regions
    from viz.pages.html import write_pdf as write_pdf
    from viz.pages.report import Report as Report, write_report as write_report
    from viz.recordings.recording import write_recording as write_recording
    from viz.rendering.cut import HALF as HALF, QUARTER as QUARTER, Wedge as Wedge
    from viz.rendering.flux import heat_flux as heat_flux
    from viz.rendering.gl import off_screen_window as off_screen_window, require_gl as require_gl
    from viz.rendering.nodes import SplitMesh as SplitMesh, split as split

__getattr__, __dir__ = loaded_when_used(__name__, __file__)
