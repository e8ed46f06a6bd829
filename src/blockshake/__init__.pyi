from blockshake.dynamics.load_motion import load_motion as load_motion
from blockshake.errors import InputError as InputError
from blockshake.geometry.structure import load_structure as load_structure
from blockshake.measurement.campaigns.campaign import load_campaign as load_campaign
from blockshake.own_files.check import check as check
from blockshake.run_diagnosis import diagnose as diagnose
from blockshake.simulation.simulate import simulate as simulate
from blockshake.study.sampling.latin_hypercube import draw_samples as draw_samples
from blockshake.study.stiffness.wave_speed import calibrate_stiffness as calibrate_stiffness
from blockshake.views.animation import animate as animate
from blockshake.views.export import export as export
from blockshake.views.figure import plot as plot

__version__: str
