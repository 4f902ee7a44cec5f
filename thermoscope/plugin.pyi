# The face for extras and plugins: what each name is, room by room from below.
from geom.arrays import Array as Array, Ints as Ints
from geom.constants import ALPHA_CU as ALPHA_CU, L_MIN as L_MIN, M3_H as M3_H, NORMAL_95 as NORMAL_95, RPM as RPM
from geom.description.machine import Machine as MachineDescription
from geom.description.materials import winding_conductivity as winding_conductivity
from geom.description.names import cut_short as cut_short, file_stem as file_stem
from geom.description.parameters import Parameter as GeometryParameter, UNITS as GEOMETRY_UNITS
from geom.description.part import Part as Part, Prism as Prism, Rod as Rod
from geom.description.profile import ArcGrid as ArcGrid, loop_length as loop_length
from geom.description.roles import Identity as Identity, Role as Role
from geom.description.toml_file import read_toml as read_toml
from geom.disk_cache import recalled as recalled, store as store
from geom.errors import NoSolution as NoSolution
from geom.escapes import c_comment as c_comment, csv_lines as csv_lines, toml_value as toml_value, xml_text as xml_text
from geom.machine_file import families as families, import_draft as import_draft
from geom.machine_file import is_foreign_machine as is_foreign_machine
from geom.limits import DROP_BYTES as DROP_BYTES
from geom.machine_file import completed as completed, library as library, machine_from as machine_from
from geom.meshing.areas import PartRow as PartRow, part_table as part_table
from geom.plugins import plugins as plugins
from geom.table import Table as Table, TableResult as TableResult, TableRow as TableRow
from geom.table import cell as cell, percent as percent
from geom.storage import cache_folder as cache_folder, write_whole as write_whole
from geom.text import counted as counted, visible as visible
from fem.solvers.snapshots import Recipe as Recipe
from lumped.build.pipeline import prepared as prepared, reduced as reduced
from lumped.circuits.hydraulics import pressure_drop as pressure_drop, pumping_power as pumping_power
from lumped.condensation.recovery import Shapes as Shapes
from lumped.correlations.end_space import SCHUBERT as SCHUBERT
from lumped.drives.coupled import coupled as coupled
from lumped.drives.drive import Controller as Controller, SeriesMachine as SeriesMachine, Vehicle as Vehicle
from lumped.drives.drive import drive_cycle as drive_cycle
from lumped.drives.duty import s3 as s3
from lumped.integration.assembly import Assembly as Assembly, assembly as assembly, input_sizes as input_sizes
from lumped.integration.assembly import starts as starts
from lumped.integration.compiled import Compiled as Compiled, READINGS as READINGS, RUN as RUN
from lumped.integration.compiled import capacity_multipliers as capacity_multipliers, capacity_slopes as capacity_slopes
from lumped.integration.compiled import compiled as compiled, state_units as state_units
from lumped.integration.ensemble import dask_cluster as dask_cluster
from lumped.integration.reach import tell_reach as tell_reach
from lumped.integration.runaway import grows as grows
from lumped.integration.signals import Signals as Signals
from lumped.integration.simulate import Stand as Stand, initial_state as initial_state
from lumped.machine.air import Stirred as Stirred
from lumped.machine.bases import Switched as Switched
from lumped.machine.jackets import Cooling as Cooling, FLOW as FLOW, INLET as INLET, channel_of as channel_of
from lumped.machine.jackets import onto_outlet as onto_outlet
from lumped.machine.films import Surroundings as Surroundings, face_films as face_films, surroundings as surroundings
from lumped.machine.motor import boundaries as boundaries, fluids as fluids, motor_network as motor_network
from lumped.machine.motor import rated_inputs as rated_inputs
from lumped.machine.outer import Cowl as Cowl, cowl_of as cowl_of
from lumped.machine.path import stem as stem
from lumped.machine.shapes import Fins as Fins, fins_of as fins_of
from lumped.model.multipliers import multipliers as multipliers, parameter_values as parameter_values, slopes as slopes
from lumped.model.multipliers import values_of as values_of
from lumped.model.network import Link as Link, Place as Place, Row as Row, Source as Source
from lumped.model.quantities import FLOWS as FLOWS, LIQUID as LIQUID, USUAL as USUAL_QUANTITIES
from lumped.model.sites import ambient as ambient
from lumped.numerics import stages as stages
from lumped.numerics.instant import instant as instant
from lumped.numerics.stages import stages as integration_stages, work as work
from lumped.numerics.steady_start import CONVERGED_K as CONVERGED_K, solve_steady_start as solve_steady_start
from lumped.numerics.terms import COLD as COLD, END as END, FILM as FILM, HOT as HOT, LAST as LAST, PLACE as PLACE
from lumped.numerics.terms import POINT as POINT, ROW as ROW, STREAM as STREAM, Terms as Terms
from lumped.schemas.bounds import COLDEST as COLDEST, HOTTEST as HOTTEST, UNITS as KEY_UNITS
from lumped.schemas.reader import Table as TomlTable, suggestion as suggestion
from lumped.sources.layer_loss import LayerLoss as LayerLoss
from lumped.sources.loss_laws import MapLoss as MapLoss
from lumped.sources.loss_laws import BrushLoss as BrushLoss, CopperLoss as CopperLoss, EDDY as EDDY
from lumped.sources.loss_laws import EddyLoss as EddyLoss, IronLoss as IronLoss, MeasuredLoss as MeasuredLoss
from lumped.sources.loss_laws import PowerLoss as PowerLoss, declared_name as declared_name
from lumped.transfer.laws import CLOCK as CLOCK, CONSTANT as CONSTANT, Conductivity as Conductivity
from lumped.transfer.laws import Constant as Constant, FILMS as FILMS, FIRST_C as FIRST_C, FULL_UNITS as FULL_UNITS
from lumped.transfer.laws import Fixed as Fixed, InputPower as InputPower, Inputs as Inputs, LEAST as LEAST, Law as Law
from lumped.transfer.laws import Linear as Linear, RUNNING as LAW_RUNNING, Radiation as Radiation, STEP_K as STEP_K
from lumped.transfer.laws import Scaled as Scaled, TemperatureLaw as TemperatureLaw, WithTemperature as WithTemperature
from lumped.transfer.properties import Fluid as Fluid, air as air, oil as oil, water as water
from lumped.transfer.ranges import RangeWarning as RangeWarning, within_silence as within_silence
from lumped.transfer.reversal import Direction as Direction, OneWay as OneWay
from lumped.transfer.streamed import Streamed as Streamed
from lumped.transfer.thin_air import density as density, thin_film as thin_film, thin_stream as thin_stream
from lumped.transfer.terms_value import coefficient as coefficient, loss_slope as loss_slope, separated as separated
from lumped.transfer.terms_value import temperature_value as temperature_value, turned as turned
from measured.case import Case as MeasuredCase, Channel as Channel, Reference as Reference, Test as Test
from measured.doubt import Doubt as Doubt, PRIOR as PRIOR, TEMPER as TEMPER, USUAL as USUAL_DOUBT, temper as temper
from measured.electrical.meters import Meter as Meter, OHMMETER as OHMMETER, VOLTMETER as VOLTMETER
from measured.electrical.propagation import PropagatedUncertainty as PropagatedUncertainty, Reading as Reading
from measured.electrical.propagation import propagate as propagate
from measured.electrical.readings import COPPER as COPPER, Magnets as Magnets, NDFEB as NDFEB, Saturation as Saturation
from measured.electrical.readings import Winding as Winding
from measured.electrical.switch_off import Cooling as CoolingCurve, Extrapolated as Extrapolated, all_ways as all_ways
from measured.electrical.switch_off import allowed_delay as allowed_delay
from measured.importing.aligned import Recording as Recording
from measured.headers.cells import number as number
from measured.importing.dialogue import Dialogue as Dialogue
from measured.importing.draft import Draft as Draft, missing_boundaries as missing_boundaries
from measured.importing.draft import missing_inputs as missing_inputs, squares_of as squares_of, test_name as test_name
from measured.importing.case_files import imported_table as imported_table, read_runs as read_runs
from measured.importing.guess import assigned as assigned, guesses as guesses
from measured.importing.source import BINARY as BINARY
from measured.importing.stream import Stream as Stream
from measured.importing.target import Target as Target, target_of as target_of
from measured.recordings.data_table import DataTable as DataTable, as_number as as_number, numbers as numbers
from measured.recordings.data_table import pairs as pairs
from measured.recordings.electrical import meter_of as meter_of, saturation_of as saturation_of
from measured.recordings.formats import SUFFIXES as SUFFIXES, each_book_once as each_book_once, read_csv as read_csv
from measured.recordings.formats import read_recording as read_recording, recording as recording
from measured.recordings.formats import recording_pieces as recording_pieces, stem_of as stem_of
from measured.recordings.sheet import Column as Column, Sheet as Sheet, load_sheet as load_sheet
from measured.recordings.tables import seconds_of as seconds_of
from measured.recordings.units import QUANTITIES as QUANTITIES
from measured.sensors.blocks import Blocks as Blocks, groups as blocks_of
from measured.sensors.operators import head as head
from validation.bands.at_rest import AtRest as AtRest
from validation.bands.posterior import ParameterPosterior as ParameterPosterior, acting as acting
from validation.bands.posterior import parameter_posterior as parameter_posterior
from validation.bases.which_base import which_base as which_base
from validation.calibration.calibrate import minimise as minimise
from validation.calibration.model_error import ModelError as ModelError, model_error as model_error
from validation.calibration.model_error import neighbours as neighbours
from validation.comparison.compare import errors as errors, physical as physical
from validation.comparison.error_budget import model_of as model_of
from validation.comparison.linearisation import Segment as Segment, segments as segments
from validation.comparison.uncertainty import moved_boundaries as moved_boundaries, moved_inputs as moved_inputs
from validation.comparison.predict import heat_model as heat_model, predict as predict, record as record
from validation.comparison.predict import thermal as thermal
from validation.comparison.uncertainty import RULE as RULE
from validation.diagnosis import diagnose as diagnose, infer as infer
from validation.effects.build import copy_element as copy_element, heat as heat_source
from validation.inference.evidence import Evidence as Evidence
from validation.inference.decide import Posterior as Posterior
from validation.inference.hypotheses import probabilities as probabilities
from validation.inference.say import explanations as explanations, hidden_effects as hidden_effects
from validation.inference.score import fit_prior as fit_prior, total as total
from validation.noise import GRID as NOISE_SHAPES
from validation.parameters.model_form import ExponentError as ExponentError, FARTHEST as FARTHEST
from validation.parameters.reference import LOADS as LOADS, effect_sizes as effect_sizes
from validation.parameters.unknowns import standing as standing, standing_reference as standing_reference
from validation.parameters.unknowns import start_name as start_name, strain_words as strain_words
from validation.parameters.unknowns import to_coordinate as to_coordinate, to_value as to_value
from validation.parameters.unknowns import value_words as value_words, with_model as with_model, working as working
from validation.revision import revise as revise
from validation.tables import bases_table as bases_table, offers as offers
from geom.one_thread import one_blas_thread as one_blas_thread
from viz.bench_run import BenchRun as BenchRun, bench_run as bench_run, journal as journal
from viz.colours import BLUE as BLUE, DARK as DARK, LIGHT as LIGHT, Theme as Theme, VERMILION as VERMILION
from viz.colours import heat as heat_colours
from viz.data import Comparison as Comparison, Sensor as Sensor, short as short, stem_and_unit as stem_and_unit
from viz.figures import paper as paper
from viz.figures.candidates import amplitude as amplitude, matrix as matrix
from viz.live.curves import confusion as confusion, sensor as sensor
from viz.live.curves import as_text as as_text, figure as figure
from viz.machine.animation import WRITERS as WRITERS, Pulses as Pulses
from viz.machine.field import machine_row as machine_row
from viz.pages import html as html
from viz.pages.html import write_pdf as write_pdf
from viz.pages.words import verdict as verdict
from viz.rendering import scene as scene
from viz.rendering.cut import QUARTER as QUARTER, Wedge as Wedge, cut_away as cut_away, framed as framed
from viz.rendering.gl import require_gl as require_gl
from viz.rendering.nodes import SplitMesh as SplitMesh, on_nodes as on_nodes, split as split
from viz.colours import rounded as rounded
from viz.rendering.scene import NOTE as NOTE, Room as Room, TITLE as TITLE, View as View
from viz.viewer.part_shapes import packed_integers as packed_integers, packed_numbers as packed_numbers
from viz.viewer.page import render as render, script as script
from thermoscope.cli import CommandGroup as CommandGroup
from thermoscope.bands import predicted_bands as predicted_bands, posterior_of as posterior_of
from thermoscope.bands import bands_requested as bands_requested
from thermoscope.case_folder.content import case_key as case_key
from thermoscope.case_folder.cycle import find_cycle as find_cycle, load_cycle as load_cycle
from thermoscope.case_folder.folder import Folder as Folder, Progress as CaseProgress, find_case as find_case
from thermoscope.case_folder.folder import load_case as load_case, load_machine_file as load_machine_file
from thermoscope.case_folder.history import History as History, Revision as StoredRevision, load_history as load_history
from thermoscope.case_folder.history import save_history as save_history
from thermoscope.case_folder.runs import added_words as added_words, at_revision as at_revision
from thermoscope.case_folder.runs import before_last as before_last, by_interest as by_interest
from thermoscope.case_folder.runs import comparison_of as comparison_of, finding_words as finding_words
from thermoscope.case_folder.runs import mean_rows as mean_rows, named_rows as named_rows, sensors as sensors
from thermoscope.case_folder.runs import step_words as step_words
from thermoscope.case_folder.stored_comparison import yardstick_document as yardstick_document
from thermoscope.case_folder.stored_comparison import yardstick_words as yardstick_words
from thermoscope.case_folder.settings import Settings as Settings, read_settings as read_settings
from thermoscope.case_folder.workbook import tables as tables, write_csvs as write_csvs, write_xlsx as write_xlsx
from thermoscope.commands.model.import_file import import_summary as import_summary, write_import as write_import
from thermoscope.commands.model.revise import evidence as evidence, recorded as recorded
from thermoscope.commands.open_case import PACKAGE as PACKAGE, open_case as open_case
from thermoscope.commands.open_case import open_case_for_writing as open_case_for_writing
from thermoscope.commands.show.pages import NO_PDF as NO_PDF, provenance as provenance, write_page as write_page
from thermoscope.commands.show.picture import Subject as Subject
from thermoscope.commands.show.viewer import stored_documents as stored_documents, viewer_documents as viewer_documents
from thermoscope.commands.open_case import current_diagnosis as current_diagnosis, save_diagnosis as save_diagnosis
from thermoscope.commands.test.new import drafts_of as drafts_of, model_of_case as model_of_case, save_case as save_case
from thermoscope.commands.use.simulate import short_of as short_of
from thermoscope.console.summary import Summary as Summary, sentences as sentences
from thermoscope.console.options import Case as CaseArgument, HotLimit as HotLimitOption, Json as JsonOption
from thermoscope.console.options import Limit as LimitOption, Out as OutOption, Sure as BandsOption
from thermoscope.console.options import read_limits as read_limits, read_pairs as read_pairs
from thermoscope.console.progress_bar import Progress as Progress, progress as progress
from thermoscope.console.terminal import STDOUT as STDOUT, give as give, notes as notes, plain as plain, say as say
from thermoscope.parts import required as required

__all__ = [
    "BandsOption",
    "CaseArgument",
    "CaseProgress",
    "CoolingCurve",
    "GEOMETRY_UNITS",
    "GeometryParameter",
    "HotLimitOption",
    "JsonOption",
    "KEY_UNITS",
    "LAW_RUNNING",
    "LimitOption",
    "MachineDescription",
    "MeasuredCase",
    "NOISE_SHAPES",
    "OutOption",
    "StoredRevision",
    "TomlTable",
    "USUAL_DOUBT",
    "USUAL_QUANTITIES",
    "blocks_of",
    "heat_colours",
    "heat_source",
    "integration_stages",
]  # what is called otherwise than at home: a type checker passes on no other name
