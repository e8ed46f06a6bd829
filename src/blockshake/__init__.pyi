from blockshake.diagnosis.gain.extended_study import extend_study as extend_study
from blockshake.diagnosis.planning.plan_campaign import plan_campaign as plan_campaign
from blockshake.dynamics.intensity import motion_figures as motion_figures
from blockshake.dynamics.intensity import response_spectrum as response_spectrum
from blockshake.dynamics.load_motion import load_motion as load_motion
from blockshake.errors import InputError as InputError
from blockshake.geometry.structure import load_structure as load_structure
from blockshake.measurement.campaigns.campaign import load_campaign as load_campaign
from blockshake.own_files.check import check as check
from blockshake.own_files.convert_motion import convert_motion as convert_motion
from blockshake.own_files.import_campaign import import_campaign as import_campaign
from blockshake.own_files.run_study import run_study as run_study
from blockshake.run_diagnosis import diagnose as diagnose
from blockshake.simulation.simulate import simulate as simulate
from blockshake.study.limit_states.largest_responses import largest_responses as largest_responses
from blockshake.study.sampling.latin_hypercube import draw_samples as draw_samples
from blockshake.study.stiffness.wave_speed import calibrate_stiffness as calibrate_stiffness
from blockshake.views.animation import animate as animate
from blockshake.views.export import export as export
from blockshake.views.figure import plot as plot

__version__: str
