"""The noise of the sensors of a test, as a campaign states it."""

from pydantic import Field

from blockshake.measurement.sensors import accelerometers, markers, transducers
from blockshake.validation import NotNegative, Strict

_LEAST_NOISE = {"marker_noise": 1e-6, "accelerometer_noise": 1e-4, "transducer_noise": 1e-6}  # m, m/s2, m


class Sensors(Strict):
    """Standard deviations of the readings."""

    marker_noise: NotNegative = Field(markers.NOISE, description="of a marker's reading [m]")
    accelerometer_noise: NotNegative = Field(
        accelerometers.NOISE, description="of a channel's reading [m/s2]"
    )
    transducer_noise: NotNegative = Field(
        transducers.NOISE,
        description="of a displacement transducer's reading [m]",
        exclude_if=lambda noise: noise == transducers.NOISE,  # sensors without it keep their digest
    )

    def not_noiseless(self):
        """The same with at least the noise of the best instruments: a stated 0 says that there is none to speak of."""
        return self.model_copy(
            update={name: max(getattr(self, name), least) for name, least in _LEAST_NOISE.items()}
        )
