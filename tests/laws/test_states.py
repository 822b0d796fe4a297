"""States on the host: the inverse inverts, and the energy is the work of the pressure."""

import numpy as np
import pytest
from scipy.integrate import quad

from warpsph.laws.states import STATE_LAWS

DENSITY, SOUND_SPEED = 1000.0, 30.0
STIFFNESS = DENSITY * SOUND_SPEED**2
PRESSURE = {
    "tait": lambda rho, gamma: STIFFNESS / gamma * np.expm1(gamma * np.log1p((rho - DENSITY) / DENSITY)),
    "linear": lambda rho: SOUND_SPEED**2 * (rho - DENSITY),
}
CASES = [("tait", (1.0,)), ("tait", (7.0,)), ("linear", ())]


@pytest.mark.parametrize(("name", "numbers"), CASES)
@pytest.mark.parametrize("strain", [-0.05, -1e-3, -2e-5, -3e-6, 3e-6, 2e-5, 1e-3, 0.05])
def test_energy_is_the_work_of_the_pressure(name, numbers, strain):
    """Against quadrature of p(rho) / rho^2. Below a strain of 1e-5 one term of a series leaves up to 5 times
    the strain, above it the closed form loses 1e-16 / strain^2 to rounding."""
    density = DENSITY * (1.0 + strain)
    work, _ = quad(
        lambda rho: PRESSURE[name](rho, *numbers) / rho**2, DENSITY, density, epsabs=0.0, epsrel=1e-12
    )
    pressure = np.array([PRESSURE[name](density, *numbers)])
    energy = STATE_LAWS[name].energy(np.array([density]), pressure, DENSITY, numbers)
    assert energy[0] == pytest.approx(work, rel=1e-4 if abs(strain) < 1e-5 else 1e-5)


@pytest.mark.parametrize(("name", "numbers"), CASES)
def test_the_inverse_gives_the_density_of_a_pressure(name, numbers):
    deviation = DENSITY * np.array([-0.1, -1e-3, -1e-8, 0.0, 1e-8, 1e-3, 0.1])
    pressure = PRESSURE[name](DENSITY + deviation, *numbers)
    found = STATE_LAWS[name].deviation(pressure, DENSITY, STIFFNESS, numbers)
    # A density of 1000 loses 1e-13 when the deviation is added to it.
    assert found == pytest.approx(deviation, rel=1e-12, abs=1e-12)
